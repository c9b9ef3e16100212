/** A relation that refinement tested in a building (B99 2). */
import { RELATION_WORDS } from "../../app/parts/reasonText";
import type { Kind } from "../parts/kind";
import { relationLimit } from "../parts/refinedBuildings";
import { allOf, links } from "../parts/rows";
import { openLine } from "../parts/shapes";

export default {
  title: "Relation",
  rows({ building, index }, { results, params }) {
    const found = results.refinement?.buildings[building]?.relations[index];
    if (found === undefined) {
      return [];
    }
    const limit = relationLimit(params);
    return [
      ["Relation", RELATION_WORDS[found.kind]],
      ["Deviation of the free solution", `${(100 * Math.abs(found.deviation_m)).toFixed(1)} cm`],
      ["χ²", `${found.chi2.toFixed(2)}${limit === null ? "" : ` (≤ ${limit})`}`],
      ["Outcome", found.adopted ? "adopted: it holds exactly now" : "rejected: the images contradict it"],
      links("Building", "refinement", [building]),
    ];
  },
  siblings: (picked, { results: { refinement } }) =>
    picked === null
      ? []
      : allOf(refinement?.buildings[picked.building]?.relations.length, (index) => ({ ...picked, index })),
  shapes: ({ building, index }, { refinement }) =>
    (refinement?.buildings[building]?.relations[index]?.sides ?? []).flatMap(({ p0, p1 }) =>
      openLine([p0, p1]),
    ),
} satisfies Kind<"relation">;

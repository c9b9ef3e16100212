/** The tour: half-planes that share a plane. */
import { counted } from "../../app/parts/counted";
import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { isMadeFrom } from "../../shared/records";
import { numberOf, pickedIndex } from "../../shared/selection";
import type { Results } from "../list";
import { ofPicked, type StageStep } from "../tourStep";

export default [
  {
    title: "Planes",
    text: "Half-planes that share a plane form a group. Its border lines, and where it meets other planes, close the facet.",
    question: "Pick a group of at least four lines that became a facet.",
    ...ofPicked(() => groupParts(results.value, pickedIndex(selection.value, "group")), {
      answer: ({ lines, facets }) =>
        `${counted(lines, "lines")}, each found on its own, lie in one plane: facet ${facets.map(numberOf).join(", ")} of the model.`,
      hint: ({ lines, facets }) =>
        facets.length === 0
          ? `${counted(lines, "lines")}, but no facet: nothing shows that there is a roof in this plane.`
          : `Facet ${facets.map(numberOf).join(", ")}, from ${counted(lines, "lines")}: look for a group with more.`,
      isFound: ({ lines, facets }) => lines >= 4 && facets.length > 0,
    }),
  },
] satisfies readonly StageStep[];

/** The lines of a group, and the facets that it became; null where there is none. */
export function groupParts({ grouping, facets }: Pick<Results, "grouping" | "facets">, group: number) {
  const found = grouping?.groups[group];
  return found === undefined
    ? null
    : {
        lines: new Set(found.members.map(({ line }) => line)).size,
        facets: (facets ?? []).flatMap((facet, i) => (isMadeFrom(facet, found) ? [i] : [])),
      };
}

/** What refinement made of a building (B99 2). */
import { refinementWords } from "../../app/parts/reasonText";
import { outlinesBefore } from "../../shared/proposed";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { OUTLINE, shapeMarks } from "../parts/marks";
import { refinedFacets } from "../parts/refinedBuildings";
import { links, numbered } from "../parts/rows";
import { facetShape, type Shape } from "../parts/shapes";

export default {
  title: "Refined building",
  rows({ index }, { results }) {
    const found = results.refinement?.buildings[index];
    if (found === undefined) {
      return [];
    }
    const adopted = found.relations.filter((one) => one.adopted).length;
    return [
      ["Reprojection error", refinementWords(found)],
      ["Straight sides", String(found.sides)],
      ["Edges measured", String(found.observations), "over all views"],
      ["Largest move", `${found.largest_move_m.toFixed(2)} m`],
      ["Relations adopted", `${adopted} of ${found.relations.length}`],
      links("Facets", "facet", refinedFacets(index, results)),
    ];
  },
  siblings: (_, { results: { refinement } }) => numbered("refinement", refinement?.buildings.length),
  shapes: ({ index }, results) => shapesOfBuilding(index, results),
  // Of a building the outlines matter, not the areas.
  marks: ({ index }, { info, results }) =>
    shapeMarks(shapesOfBuilding(index, results), info, { area: OUTLINE }),
} satisfies Kind<"refinement">;

function shapesOfBuilding(index: number, results: Results): Shape[] {
  const before = results.refinement === null ? [] : outlinesBefore(results.refinement, index);
  return [
    ...before.map((points): Shape => ({ points, role: "before" })),
    ...refinedFacets(index, results).flatMap((facet) => facetShape(facet, results)),
  ];
}

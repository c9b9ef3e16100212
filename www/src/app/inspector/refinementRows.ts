/** What refinement made of buildings (B99 2), for the inspector and the figure. */

import { RELATION_WORDS, refinementWords } from "../parts/reasonText";
import { buildingOfFacet, refinedFacets, relationLimit } from "../selection/refinedBuildings";
import { params } from "../state/parameters";
import { results } from "../state/results";
import { linkToFacet, linkToRefinement, type Row } from "./rowLinks";

/** The refinement of the building that a facet is part of. */
export function refinedRow(facet: number): Row[] {
  const building = buildingOfFacet(facet, results.value);
  const found = results.value.refinement?.buildings[building ?? -1];
  return building === undefined || found === undefined
    ? []
    : [["Refined", [linkToRefinement(building)], refinementWords(found)]];
}

export function refinementRows(index: number): Row[] {
  const found = results.value.refinement?.buildings[index];
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
    ["Facets", refinedFacets(index, results.value).map(linkToFacet)],
  ];
}

export function relationRows(building: number, index: number): Row[] {
  const found = results.value.refinement?.buildings[building]?.relations[index];
  if (found === undefined) {
    return [];
  }
  const limit = relationLimit(params.value);
  return [
    ["Relation", RELATION_WORDS[found.kind]],
    ["Deviation of the free solution", `${(100 * Math.abs(found.deviation_m)).toFixed(1)} cm`],
    ["χ²", `${found.chi2.toFixed(2)}${limit === null ? "" : ` (≤ ${limit})`}`],
    ["Outcome", found.adopted ? "adopted: it holds exactly now" : "rejected: the images contradict it"],
    ["Building", [linkToRefinement(building)]],
  ];
}

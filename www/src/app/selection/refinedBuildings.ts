/** Which facets refinement took from which buildings, and how it judges relations (B99 2). */
import { params } from "../state/parameters";
import { results } from "../state/results";

/** The facets of the model that refinement made of a building. */
export function refinedFacets(building: number): number[] {
  const before = results.value.refinement?.before;
  return (before?.sources ?? []).flatMap((source, facet) =>
    before?.facets[source]?.building === building ? [facet] : [],
  );
}

/** The building that a facet of the model belonged to before refinement. */
export function buildingOfFacet(facet: number): number | undefined {
  const before = results.value.refinement?.before;
  return before?.facets[before.sources[facet] ?? -1]?.building;
}

/** Up to this chi-square a relation is adopted, as the present parameters have it. */
export function relationLimit(): number | null {
  const refine = params.value["roof"]?.["refine"];
  const limit = (refine as Record<string, unknown> | undefined)?.["relation_chi2"];
  return typeof limit === "number" ? limit : null;
}

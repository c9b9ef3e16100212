/** Which facets refinement took from which buildings, and how it judges relations (B99 2). */
import type { Results } from "../../shared/figure";
import type { ParamTree } from "../../shared/paramTree";

/** The facets of the model that refinement made of a building. */
export function refinedFacets(building: number, { refinement }: Pick<Results, "refinement">): number[] {
  const before = refinement?.before;
  return (before?.sources ?? []).flatMap((source, facet) =>
    before?.facets[source]?.building === building ? [facet] : [],
  );
}

/** The building that a facet of the model belonged to before refinement. */
export function buildingOfFacet(
  facet: number,
  { refinement }: Pick<Results, "refinement">,
): number | undefined {
  const before = refinement?.before;
  return before?.facets[before.sources[facet] ?? -1]?.building;
}

/** Up to this chi-square a relation is adopted, as the present parameters have it. */
export function relationLimit(params: ParamTree): number | null {
  const refine = params["roof"]?.["refine"];
  const limit = (refine as Record<string, unknown> | undefined)?.["relation_chi2"];
  return typeof limit === "number" ? limit : null;
}

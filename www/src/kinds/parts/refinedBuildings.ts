/** Which facets refinement took from which buildings, and how it judges relations (B99 2). */

import type { ParamTree } from "../../shared/paramTree";
import type { Results } from "../../stages/list";

/** The facets of the model that refinement made of a building. */
export function refinedFacets(building: number, found: Refined): number[] {
  const before = found.refinement?.before;
  return sourcesOf(found).flatMap((source, facet) =>
    before?.facets[source ?? -1]?.building === building ? [facet] : [],
  );
}

/** The building that a facet of the model belonged to before refinement. */
export function buildingOfFacet(facet: number, found: Refined): number | undefined {
  return found.refinement?.before.facets[sourcesOf(found)[facet] ?? -1]?.building;
}

type Refined = Pick<Results, "refinement"> & Partial<Pick<Results, "corrected">>;

/** For every facet of the model, corrected by hand or not, its index before refinement; null for one that was added. */
function sourcesOf({ refinement, corrected }: Refined): readonly (number | null)[] {
  const sources = refinement?.before.sources ?? [];
  return corrected == null
    ? sources
    : corrected.sources.map((facet) => (facet === null ? null : (sources[facet] ?? null)));
}

/** Up to this chi-square a relation is adopted, as the present parameters have it. */
export function relationLimit(params: ParamTree): number | null {
  const refine = params["roof"]?.["refine"];
  const limit = (refine as Record<string, unknown> | undefined)?.["relation_chi2"];
  return typeof limit === "number" ? limit : null;
}

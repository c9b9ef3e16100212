import type { ParamTree } from "../../shared/paramTree";
import type { Facet, FacetTrace } from "../../shared/records";
import type { ResultSource, Stage } from "../stage";

export const facets = {
  about: "facet",
  nothing: {
    facets: null as Facet[] | null,
    /** The parameters that the facets were found with. */
    madeWith: null as ParamTree | null,
    verification: null as FacetTrace | null,
  },
  fetch: async (from) => ({
    ...(await fetchFacets(from)),
    verification: await from.call("verification"),
    // Of other facets.
    refinement: null,
  }),
  known: ["register", "terrain", "cloud"],
} satisfies Stage;

/** Facets that a stage has found anew: nothing is corrected in them. */
export async function fetchFacets(from: ResultSource) {
  return { facets: await from.call("facets"), corrected: null, madeWith: from.params };
}

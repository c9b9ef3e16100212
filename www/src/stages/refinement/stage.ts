import type { Refinement } from "../../shared/records";
import { fetchFacets } from "../facets/stage";
import { fetchLines } from "../lines/stage";
import type { Stage } from "../stage";

export const refinement = {
  about: "refinement",
  nothing: { refinement: null as Refinement | null },
  fetch: async (from) => ({
    ...(await fetchFacets(from)),
    refinement: await from.call("refinement"),
    // The model adds new lines to the matched ones.
    ...(await fetchLines(from)),
  }),
  sections: { "roof.refine": "Regularisation and refinement" },
} satisfies Stage;

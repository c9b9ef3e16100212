import type { CorrectionTrace } from "../../shared/records";
import type { Stage } from "../stage";

export const corrections = {
  shownBy: "model",
  nothing: {
    /** What became of corrections by hand; the facets are the corrected ones then. */
    corrected: null as CorrectionTrace | null,
  },
  fetch: async (from) => ({
    facets: await from.call("facets"),
    corrected: await from.call("corrected"),
  }),
} satisfies Stage;

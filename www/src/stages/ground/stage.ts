import type { KnownComparison } from "../../shared/records";
import type { Stage } from "../stage";

export const ground = {
  shownBy: "lines",
  nothing: {
    /** How the terrain model that is known beforehand compares with the images. */
    terrain: null as KnownComparison | null,
  },
  fetch: async (from) => ({ terrain: await from.call("terrain") }),
} satisfies Stage;

import type { Directions } from "../../shared/records";
import type { Stage } from "../stage";

export const directions = {
  about: "segment",
  nothing: { directions: null as Directions | null },
  fetch: async (from) => ({ directions: await from.call("directions") }),
  sections: { "objectspace.windows": "Windows", "objectspace.directions": "Main directions" },
  mainCount: "pairs of directions",
} satisfies Stage;

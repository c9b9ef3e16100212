import type { CoplanarSets } from "../../shared/records";
import type { Stage } from "../stage";

export const coplanar = {
  about: "coplanar",
  nothing: { coplanar: null as CoplanarSets | null },
  fetch: async (from) => ({ coplanar: await from.call("coplanar") }),
} satisfies Stage;

import type { HalfPlane, SideRecord } from "../../shared/records";
import type { Stage } from "../stage";

export const halfplanes = {
  about: "halfplane",
  nothing: { halfPlanes: null as HalfPlane[] | null, sides: [] as SideRecord[] },
  fetch: async (from) => ({
    halfPlanes: await from.call("halfPlanes"),
    sides: await from.call("sides"),
  }),
  sections: { sweep: "Half-plane sweep" },
  mainCount: "half-planes",
  known: ["terrain"],
} satisfies Stage;

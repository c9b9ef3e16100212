import type { HalfPlane, SideRecord, TerrainComparison } from "../../shared/records";
import type { Stage } from "../stage";

export const halfplanes = {
  // These sweep no half-plane; of the stage they have the ground.
  hiddenIn: ["coplanar", "adjacency"],
  nothing: {
    halfPlanes: null as HalfPlane[] | null,
    sides: [] as SideRecord[],
    /** How the terrain model that is known beforehand compares with the images. */
    terrain: null as TerrainComparison | null,
  },
  fetch: async (from) => ({
    halfPlanes: await from.call("halfPlanes"),
    sides: await from.call("sides"),
    terrain: await from.call("terrain"),
  }),
  sections: { sweep: "Half-plane sweep" },
  mainCount: "half-planes",
  known: ["terrain"],
} satisfies Stage;

import type { DensePlanes } from "../../shared/records";
import type { Stage } from "../stage";

export const dense = {
  about: "dense",
  nothing: { dense: null as DensePlanes | null },
  fetch: async (from) => ({ dense: await from.call("dense") }),
  sections: { point_cloud: "Point cloud" },
  known: ["cloud"],
} satisfies Stage;

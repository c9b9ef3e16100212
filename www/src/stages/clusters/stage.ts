import type { ClusterTrace } from "../../shared/records";
import { fetchLines } from "../lines/stage";
import type { Stage } from "../stage";

export const clusters = {
  about: "line",
  nothing: { clusters: null as ClusterTrace[] | null },
  fetch: async (from) => ({ ...(await fetchLines(from)), clusters: await from.call("clusters") }),
  sections: { "objectspace.clusters": "Clusters" },
} satisfies Stage;

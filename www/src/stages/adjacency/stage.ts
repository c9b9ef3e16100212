import type { AdjacencyGraphs } from "../../shared/records";
import type { Stage } from "../stage";

export const adjacency = {
  about: "corner",
  tabTitle: "Adjacency",
  nothing: { adjacency: null as AdjacencyGraphs | null },
  fetch: async (from) => ({ adjacency: await from.call("adjacency") }),
} satisfies Stage;

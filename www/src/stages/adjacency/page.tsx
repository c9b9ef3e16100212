/** Corners in space with their edges and planes. */
import { planOf, type StagePage } from "../stagePage";
import { buildAdjacency } from "./adjacencyLayer";

export default {
  layers: {
    adjacency: {
      title: "Corners",
      plan: planOf(({ adjacency }) => [adjacency], buildAdjacency),
      pickOrder: 7,
      isMeasured: true,
    },
  },
  shows: ["adjacency"],
  isEmpty: ({ adjacency }) => adjacency === null,
} satisfies StagePage;

/** Corners in space with their edges and planes. */
import { results } from "../../app/state/results";
import type { StagePage } from "../stagePage";
import { buildAdjacency } from "./adjacencyLayer";

export default {
  layers: {
    adjacency: {
      title: "Corners",
      plan: () => {
        const { adjacency } = results.value;
        return adjacency && [() => buildAdjacency(adjacency), adjacency];
      },
      pickOrder: 7,
      isMeasured: true,
    },
  },
  shows: ["adjacency"],
  isEmpty: ({ adjacency }) => adjacency === null,
} satisfies StagePage;

/** Buildings before refinement, over the facets. */
import { results } from "../../app/state/results";
import { tab } from "../../app/state/viewState";
import type { StagePage } from "../stagePage";
import { buildRefinement } from "./refinementLayer";

export default {
  layers: {
    refinement: {
      plan: () => {
        const { refinement } = results.value;
        return refinement && [() => buildRefinement(refinement), refinement];
      },
      isSeen: () => tab.value === "refinement",
    },
  },
  shows: ["facets"],
  isEmpty: ({ refinement }) => refinement === null,
} satisfies StagePage;

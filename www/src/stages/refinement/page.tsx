/** Buildings before refinement, over the facets. */
import { tab } from "../../app/state/viewState";
import { planOf, type StagePage } from "../stagePage";
import { buildRefinement } from "./refinementLayer";

export default {
  layers: {
    refinement: {
      plan: planOf(({ refinement }) => [refinement], buildRefinement),
      isSeen: () => tab.value === "refinement",
    },
  },
  shows: ["facets"],
  isEmpty: ({ refinement }) => refinement === null,
} satisfies StagePage;

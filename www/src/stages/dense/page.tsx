/** The patches of dense matching in space. */
import { results } from "../../app/state/results";
import type { StagePage } from "../stagePage";
import { buildDense } from "./denseLayer";

export default {
  layers: {
    dense: {
      title: "Dense planes",
      // Thousands of patches.
      plan: ({ isChosen }) => {
        const { dense } = results.value;
        return isChosen && dense !== null ? [() => buildDense(dense), dense] : null;
      },
      pickOrder: 8,
      isMeasured: true,
    },
  },
  shows: ["dense"],
  isEmpty: ({ dense }) => dense === null,
} satisfies StagePage;

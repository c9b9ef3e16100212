/** Sets of coplanar lines in space. */
import { planOf, type StagePage } from "../stagePage";
import { buildCoplanar } from "./coplanarLayer";

export default {
  layers: {
    coplanar: {
      title: "Coplanar sets",
      plan: planOf(({ coplanar, lines }) => [coplanar, lines], buildCoplanar),
      pickOrder: 6,
      isMeasured: true,
    },
  },
  shows: ["coplanar"],
  isEmpty: ({ coplanar }) => coplanar === null,
} satisfies StagePage;

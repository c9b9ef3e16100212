/** Sets of coplanar lines in space. */
import { results } from "../../app/state/results";
import type { StagePage } from "../stagePage";
import { buildCoplanar } from "./coplanarLayer";

export default {
  layers: {
    coplanar: {
      title: "Coplanar sets",
      plan: () => {
        const { lines, coplanar } = results.value;
        return lines && coplanar && [() => buildCoplanar(coplanar, lines), coplanar, lines];
      },
      pickOrder: 6,
      isMeasured: true,
    },
  },
  shows: ["coplanar"],
  isEmpty: ({ coplanar }) => coplanar === null,
} satisfies StagePage;

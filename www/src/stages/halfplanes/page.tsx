/** Half-planes in space, and the one that is turned by hand. */

import { results } from "../../app/state/results";
import { selectionDetail } from "../../app/state/selectionDetail";
import { tab } from "../../app/state/viewState";
import { lineEnds } from "../../kinds/parts/shapes";
import type { HalfPlane, Vec3 } from "../../shared/records";
import { ENDS, PLANE } from "../sample";
import { planOf, type StagePage } from "../stagePage";
import { buildFans, buildTurning } from "./fansLayer";

const HALF_PLANE: HalfPlane = {
  line: 0,
  side: "left",
  theta: 0,
  sigma_theta: 0,
  similarity: 1,
  curvature: 1,
  amplitude: 1,
  probability: 1,
  views: [],
  plane: PLANE,
};

export default {
  layers: {
    fans: {
      title: "Half-planes",
      plan: planOf(({ halfPlanes, lines, sides }) => [halfPlanes, lines, sides], buildFans),
      pickOrder: 5,
      warm: () => buildFans([HALF_PLANE], ENDS, [{ line: 0, side: "right", rejection: "flat_curve" }]),
    },
    turning: {
      plan: () => {
        const { side, theta } = selectionDetail.value;
        const ends = side === null ? [] : lineEnds(side.line, results.value);
        return side !== null && ends.length === 2 && tab.value === "halfplanes"
          ? [() => buildTurning(ends as unknown as [Vec3, Vec3], side.side, theta), side, theta]
          : null;
      },
      isSeen: () => true,
    },
  },
  shows: ["lines", "fans"],
  isEmpty: ({ halfPlanes }) => halfPlanes === null,
} satisfies StagePage;

/** 3D lines as the segments alone give them, for comparison with the merged and grown ones (B99 figures 5 to 8). */

import { STRETCH_STRIDE } from "../../shared/flatArrays";
import { PALETTE } from "../../shared/palette";
import { zUpGroup } from "../../viewer/scene/frame";
import { disposeObject, type Layer } from "../../viewer/scene/layer";
import { strokes } from "../../viewer/scene/strokes";

/** As wide as the lines that they are compared with. */
const WIDTH_PX = 2.25;

/** @param stretches line, p0 and p1 of each stretch, local frame, metres */
export function buildStretches(stretches: Float64Array): Layer {
  const object = zUpGroup();
  const count = Math.floor(stretches.length / STRETCH_STRIDE);
  const positions: number[] = [];
  for (let i = 0; i < count; i += 1) {
    positions.push(...stretches.subarray(i * STRETCH_STRIDE + 1, (i + 1) * STRETCH_STRIDE));
  }
  object.add(strokes(positions, PALETTE.line, WIDTH_PX));
  return {
    object,
    pick: (hit) => {
      const line = stretches[(hit.faceIndex ?? -1) * STRETCH_STRIDE];
      return line === undefined ? null : { kind: "line", index: line };
    },
    highlight: () => undefined,
    dispose: () => disposeObject(object),
  };
}

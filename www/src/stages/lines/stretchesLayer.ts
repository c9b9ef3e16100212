/** 3D lines as the segments alone give them, for comparison with the merged and grown ones (B99 figures 5 to 8). */

import { STRETCH_STRIDE } from "../../shared/flatArrays";
import { PALETTE } from "../../shared/palette";
import type { Layer } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";
import { strokes } from "../../viewer/scene/strokes";

/** As wide as the lines that they are compared with. */
const WIDTH_PX = 2.25;

/** @param stretches line, p0 and p1 of each stretch, local frame, metres */
export function buildStretches(stretches: Float64Array): Layer {
  const count = Math.floor(stretches.length / STRETCH_STRIDE);
  const own = Array.from({ length: count }, (_, i) =>
    stretches.subarray(i * STRETCH_STRIDE, (i + 1) * STRETCH_STRIDE),
  );
  const positions = own.flatMap((stretch) => [...stretch.subarray(1)]);
  const drawn = strokes(positions, PALETTE.line, WIDTH_PX);
  return partsLayer({ kind: "line", parts: [{ drawn, things: own.map(([line = -1]) => line) }] });
}

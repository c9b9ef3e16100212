/** The colours of image lines by the main direction that they follow. */

import { SEGMENT_STRIDE, segmentAt } from "../../shared/flatArrays";
import { lineThrough } from "../../shared/linear";
import { category } from "../../shared/palette";
import type { Vec2 } from "../../shared/records";
import type { Figure } from "../figure";

/** A right angle: from the first direction to the other. */
const HALF = Math.PI / 2;

/** The main direction that an image line may follow: its interpretation plane cut with the XY plane (W96 3.4). */
export function directionColours(
  view: number,
  { scene, results, plane }: Pick<Figure, "scene" | "results" | "plane">,
): (string | null)[] | null {
  const info = scene?.views[view];
  const segments = results.segments[view];
  const pair = results.directions?.windows[plane]?.directions[0];
  if (info === undefined || segments === undefined || pair === undefined) {
    return null;
  }
  const p = info.projection;
  const tolerance = (3 * Math.PI) / 180;
  return Array.from({ length: segments.length / SEGMENT_STRIDE }, (_, i) => {
    const line = lineThrough(...(segmentAt(segments, i) as [Vec2, Vec2]));
    const normal = (column: number) =>
      line.reduce((sum, l, row) => sum + l * (p[4 * row + column] as number), 0);
    const azimuth = Math.atan2(-normal(0), normal(1));
    const off = (angle: number) =>
      Math.abs(((((azimuth - angle) % Math.PI) + 1.5 * Math.PI) % Math.PI) - HALF);
    return off(pair.azimuth) < tolerance
      ? category(0)
      : off(pair.azimuth + HALF) < tolerance
        ? category(1)
        : null;
  });
}

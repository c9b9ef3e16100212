/** A half-plane as a strip from its line, for the eye only: it has no width of its own. */
import { lineAt } from "../../shared/flatArrays";
import { add, clamp, cross, norm, scaled, sub, unit } from "../../shared/linear";
import type { HalfPlane, Vec3 } from "../../shared/records";

/** Width of a fan over the length of its line, and its limits in metres. */
const RELATIVE_WIDTH = 0.35;
const WIDTH_M = { min: 0.6, max: 3 };

const NO_LINE: readonly [Vec3, Vec3] = [
  [0, 0, 0],
  [0, 0, 0],
];

/** Start and end on the line, then end and start away from it; local frame, metres. */
export function fanRing(halfPlane: HalfPlane, lines: Float64Array): [Vec3, Vec3, Vec3, Vec3] {
  const ends = lineAt(lines, halfPlane.line) ?? NO_LINE;
  return ringFrom(ends, awayFromLine(halfPlane, unit(sub(ends[1], ends[0]))));
}

/** The same of a line and a unit vector away from it. */
export function ringFrom([p0, p1]: readonly [Vec3, Vec3], away: Vec3): [Vec3, Vec3, Vec3, Vec3] {
  const width = clamp(norm(sub(p1, p0)) * RELATIVE_WIDTH, WIDTH_M.min, WIDTH_M.max);
  return [p0, p1, add(p1, away, width), add(p0, away, width)];
}

/** The unit vector in the half-plane across its line: to the left or right of it, seen from above. */
function awayFromLine({ plane, side }: HalfPlane, along: Vec3): Vec3 {
  const away = unit(cross(plane.normal, along));
  const isLeft = away[1] * along[0] - away[0] * along[1] > 0;
  return scaled(away, isLeft === (side === "left") ? 1 : -1);
}

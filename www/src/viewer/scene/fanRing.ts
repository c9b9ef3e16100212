/** A half-plane as a strip from its line, for the eye only: it has no width of its own. */
import { LINE_STRIDE } from "../../shared/flatArrays";
import type { HalfPlane, Vec3 } from "../../shared/records";

/** Width of a fan over the length of its line, and its limits in metres. */
const RELATIVE_WIDTH = 0.35;
const WIDTH_M = { min: 0.6, max: 3 };

export function fanWidth(lengthM: number): number {
  return Math.min(WIDTH_M.max, Math.max(WIDTH_M.min, lengthM * RELATIVE_WIDTH));
}

/** Start and end on the line, then end and start away from it; local frame, metres. */
export function fanRing(halfPlane: HalfPlane, lines: Float64Array): [Vec3, Vec3, Vec3, Vec3] {
  const at = halfPlane.line * LINE_STRIDE;
  const end = (from: number): Vec3 => [lines[from] ?? 0, lines[from + 1] ?? 0, lines[from + 2] ?? 0];
  const [p0, p1] = [end(at), end(at + 3)];
  const along: Vec3 = [p1[0] - p0[0], p1[1] - p0[1], p1[2] - p0[2]];
  const away = awayFromLine(halfPlane, unit(along));
  const width = fanWidth(Math.hypot(...along));
  const beside = (p: Vec3): Vec3 => [p[0] + width * away[0], p[1] + width * away[1], p[2] + width * away[2]];
  return [p0, p1, beside(p1), beside(p0)];
}

/** The unit vector in the half-plane across its line: to the left or right of it, seen from above. */
function awayFromLine({ plane, side }: HalfPlane, [dx, dy, dz]: Vec3): Vec3 {
  const [nx, ny, nz] = plane.normal;
  const away = unit([ny * dz - nz * dy, nz * dx - nx * dz, nx * dy - ny * dx]);
  const isLeft = away[1] * dx - away[0] * dy > 0;
  return isLeft === (side === "left") ? away : [-away[0], -away[1], -away[2]];
}

function unit([x, y, z]: Vec3): Vec3 {
  const length = Math.hypot(x, y, z) || 1;
  return [x / length, y / length, z / length];
}

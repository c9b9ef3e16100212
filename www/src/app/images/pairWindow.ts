/** The window of a pair of parallel lines in space, and the image lines inside it (W96 figures 10 and 11). */

import type { PlaneTrace, Vec3 } from "../../shared/records";
import type { Results } from "../../stages/list";
import { lineEnds } from "../selection/selectionShapes";

export interface PlaneWindow {
  /** Around both lines. */
  outline: readonly Vec3[];
  /** The image lines that cross it, cut with its plane. */
  crossings: readonly { view: number; ends: readonly [Vec3, Vec3] }[];
}

/** Positions along the lines count from where the plane across them through the origin cuts them, as in the core. */
export function windowOf(
  { lines, crossings }: PlaneTrace,
  results: Pick<Results, "lines">,
): PlaneWindow | null {
  const [a, b] = lineEnds(lines[0], results);
  const [c, d] = lineEnds(lines[1], results);
  if (a === undefined || b === undefined || c === undefined || d === undefined) {
    return null;
  }
  const u = unit([b[0] - a[0], b[1] - a[1], b[2] - a[2]]);
  const [first, second] = [foot(a, u), foot(c, u)];
  const width = Math.hypot(second[0] - first[0], second[1] - first[1], second[2] - first[2]);
  /** `t` along the lines, `w` from the first to the second. */
  const at = (t: number, w: number): Vec3 => {
    const on = (k: 0 | 1 | 2) => first[k] + t * u[k] + ((second[k] - first[k]) * w) / width;
    return [on(0), on(1), on(2)];
  };
  const reach = [a, b, c, d].map((p) => dot(p, u));
  const [from, to] = [Math.min(...reach), Math.max(...reach)];
  return {
    outline: [at(from, 0), at(to, 0), at(to, width), at(from, width)],
    crossings: crossings.map(({ view, at: [t0, t1], across: [w0, w1] }) => {
      const along = (w: number) => t0 + ((t1 - t0) * w) / width;
      return { view, ends: [at(along(w0), w0), at(along(w1), w1)] };
    }),
  };
}

function unit(v: Vec3): Vec3 {
  const length = Math.hypot(...v);
  return [v[0] / length, v[1] / length, v[2] / length];
}

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Where the line through a point cuts the plane across it through the origin. */
function foot(p: Vec3, u: Vec3): Vec3 {
  const t = dot(p, u);
  return [p[0] - t * u[0], p[1] - t * u[1], p[2] - t * u[2]];
}

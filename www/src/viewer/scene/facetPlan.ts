/** Facets seen from above: what belongs to roofs, and where a facet's name stands. */
import { edgesOf, isInside } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";

/** A border line follows its facet this well, metres: what is farther away is on the ground. */
const REACH_M = 0.5;

type Ring = readonly (readonly number[])[];

/** Whether a line in plan runs inside a facet or at its outline. */
export function isOfRoof({ a, b }: { a: Vec2; b: Vec2 }, outlines: readonly Ring[]): boolean {
  const middle: Vec2 = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  return outlines.some((ring) => isInside(middle, ring) || distanceTo(middle, ring) < REACH_M);
}

/** A place in a facet for its name: the middle of its triangles, weighted by area, or of its corners where it has none. */
export function middleOf(ring: readonly Vec3[]): Vec3 {
  const first = ring[0] ?? [0, 0, 0];
  let [area, x, y, z] = [0, 0, 0, 0];
  for (let i = 1; i + 1 < ring.length; i += 1) {
    const [p, q] = [ring[i] as Vec3, ring[i + 1] as Vec3];
    const own = (p[0] - first[0]) * (q[1] - first[1]) - (q[0] - first[0]) * (p[1] - first[1]);
    area += own;
    x += (own * (first[0] + p[0] + q[0])) / 3;
    y += (own * (first[1] + p[1] + q[1])) / 3;
    z += (own * (first[2] + p[2] + q[2])) / 3;
  }
  return Math.abs(area) < 1e-9 ? first : [x / area, y / area, z / area];
}

function distanceTo([x, y]: Vec2, ring: Ring): number {
  const distances = edgesOf(ring).map(([[ax = 0, ay = 0], [bx = 0, by = 0]]) => {
    const [dx, dy] = [bx - ax, by - ay];
    const along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
    const t = Math.min(1, Math.max(0, along));
    return Math.hypot(x - ax - t * dx, y - ay - t * dy);
  });
  return Math.min(...distances);
}

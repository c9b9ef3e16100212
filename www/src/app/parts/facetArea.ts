/** Areas of facets, for tables. */
import type { Facet, Vec3 } from "../../shared/records";

/** Sloped area, square metres: that of the plan over the cosine of the slope. */
export function slopedArea({ outer, holes, plane }: Pick<Facet, "outer" | "holes" | "plane">): number {
  const plan = Math.abs(planArea(outer)) - holes.reduce((sum, hole) => sum + Math.abs(planArea(hole)), 0);
  return plan / Math.max(1e-6, Math.abs(plane.normal[2]));
}

function planArea(ring: readonly Vec3[]): number {
  return ring.reduce((sum, [x, y], i) => {
    const [nextX, nextY] = ring[(i + 1) % ring.length] as Vec3;
    return sum + (x * nextY - nextX * y) / 2;
  }, 0);
}

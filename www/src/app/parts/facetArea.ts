/** Areas of facets, for tables. */
import { planArea } from "../../shared/linear";
import type { Facet } from "../../shared/records";

/** Sloped area, square metres: that of the plan over the cosine of the slope. */
export function slopedArea({ outer, holes, plane }: Pick<Facet, "outer" | "holes" | "plane">): number {
  const plan = Math.abs(planArea(outer)) - holes.reduce((sum, hole) => sum + Math.abs(planArea(hole)), 0);
  return plan / Math.max(1e-6, Math.abs(plane.normal[2]));
}

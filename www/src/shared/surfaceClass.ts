/** Heights, slopes and areas of planes, and what those of dense matching are: building, ground or vegetation. */
import { planArea } from "./linear";
import type { DensePlane, DensePlanes, Facet, SurfaceClass } from "./records";

export const CLASSES = ["building", "ground", "vegetation"] as const;
export type ClassName = (typeof CLASSES)[number];

/** The most probable class; of equal ones the first. */
export function likeliestClass(of: SurfaceClass): { name: ClassName; probability: number } {
  const name = CLASSES.reduce((best, one) => (of[one] > of[best] ? one : best));
  return { name, probability: of[name] };
}

/** The plane of each patch; -1 where it has none. */
export function planesOfPatches({ planes, trace }: DensePlanes): Int32Array {
  const owners = new Int32Array(trace.patches.length).fill(-1);
  planes.forEach(({ patches }, plane) => {
    for (const patch of patches) {
      owners[patch] = plane;
    }
  });
  return owners;
}

/** Rise per metre of a plane along x and y. */
export function gradientOf({ plane: { normal } }: Pick<DensePlane, "plane">): [number, number] {
  return [-normal[0] / normal[2], -normal[1] / normal[2]];
}

/** The height of a plane at a place, metres. */
export function heightAt({ plane: { normal, d } }: Pick<DensePlane, "plane">, x: number, y: number): number {
  return -(normal[0] * x + normal[1] * y + d) / normal[2];
}

/** Standard deviation of a plane's slope, radians, from that of its gradient; of a level one along x or y, whichever is larger. */
export function slopeSigma(plane: Pick<DensePlane, "plane" | "covariance">): number {
  const [gx, gy] = gradientOf(plane);
  const rise = Math.hypot(gx, gy);
  const [, [, xx, xy], [, , yy]] = plane.covariance;
  const along = rise === 0 ? Math.max(xx, yy) : (gx * gx * xx + 2 * gx * gy * xy + gy * gy * yy) / rise ** 2;
  return Math.sqrt(along) / (1 + rise ** 2);
}

/** Area along the slope, square metres: that of the plan over the cosine of the slope. */
export function slopedArea({ outer, holes, plane }: Pick<Facet, "outer" | "holes" | "plane">): number {
  const plan = Math.abs(planArea(outer)) - holes.reduce((sum, hole) => sum + Math.abs(planArea(hole)), 0);
  return plan / Math.max(1e-6, Math.abs(plane.normal[2]));
}

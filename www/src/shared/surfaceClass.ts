/** What the planes of dense matching are: building, ground or vegetation. */
import type { DensePlane, DensePlanes, SurfaceClass } from "./records";

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

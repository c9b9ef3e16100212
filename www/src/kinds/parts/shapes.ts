/** What things are in space: polylines in the local frame, which light up in every image and in the 3D view. */

import { LINE_STRIDE } from "../../shared/flatArrays";
import type { Vec3 } from "../../shared/records";
import type { Results } from "../../stages/list";

/** A line, a closed outline with what is inside it, or the outline of what was there before. */
export interface Shape {
  points: readonly Vec3[];
  role: "line" | "area" | "before";
}

/** The end points of a 3D line; none where there is no such line. */
export function lineEnds(index: number, { lines }: Pick<Results, "lines">): Vec3[] {
  const at = index * LINE_STRIDE;
  if (lines === null || at + LINE_STRIDE > lines.length) {
    return [];
  }
  const n = [...lines.subarray(at, at + LINE_STRIDE)] as [number, number, number, number, number, number];
  return [
    [n[0], n[1], n[2]],
    [n[3], n[4], n[5]],
  ];
}

export function linesShape(indices: readonly number[], results: Pick<Results, "lines">): Shape[] {
  return indices.flatMap((line) => openLine(lineEnds(line, results)));
}

export function openLine(points: readonly Vec3[]): Shape[] {
  return points.length < 2 ? [] : [{ points, role: "line" }];
}

export function areas(rings: readonly (readonly Vec3[])[]): Shape[] {
  return rings.filter((ring) => ring.length > 0).map((points) => ({ points, role: "area" }));
}

export function facetShape(index: number, { facets }: Pick<Results, "facets">): Shape[] {
  const facet = facets?.[index];
  return facet === undefined ? [] : areas([facet.outer, ...facet.holes]);
}

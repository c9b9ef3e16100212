/** What a picture has to show: points in the viewer's frame, and where a camera stands that sees them all. */
import { Box3, type BufferAttribute, Mesh, type Object3D, type Sphere, Vector3 } from "three";
import { LINE_STRIDE } from "../../shared/flatArrays";
import type { Facet, Vec3 } from "../../shared/records";
import { yUp } from "./frame";

/** This share of the coordinates at either end is left out, so that one stray line does not set the scale. */
const OUTLIERS = 0.04;
/** Nearer than this, metres, there is nothing to be seen. */
const LEAST_DISTANCE_M = 12;
/** Half the width of what is looked at while there is nothing. */
const EMPTY_M = 12;

/** Room about what is looked at, for the tools above it. */
export const ROOM = 1.2;
/** What is so many times smaller than what was looked at is too small in its picture. */
const MUCH_SMALLER = 1.5;

/** Does a camera that looks at the one show the other as it should? */
export function isNearlySame(seen: Sphere, next: Sphere): boolean {
  const isInside = seen.center.distanceTo(next.center) + next.radius <= ROOM * seen.radius;
  return isInside && seen.radius <= MUCH_SMALLER * next.radius;
}

export function cornersOf(object: Object3D): Vector3[] {
  object.updateWorldMatrix(true, true);
  const corners: Vector3[] = [];
  object.traverse((part) => {
    if (part instanceof Mesh) {
      const positions = part.geometry.getAttribute("position") as BufferAttribute;
      for (let i = 0; i < positions.count; i += 1) {
        corners.push(new Vector3().fromBufferAttribute(positions, i).applyMatrix4(part.matrixWorld));
      }
    }
  });
  return corners;
}

export function cornersOfFacets(facets: readonly Facet[]): Vector3[] {
  return facets.flatMap(({ outer }) => outer.map(yUp));
}

/** @param lines p0 and p1 of each line, local frame, metres */
export function endsOfLines(lines: Float64Array): Vector3[] {
  if (lines.length < LINE_STRIDE) {
    return [new Vector3(-EMPTY_M, 0, -EMPTY_M), new Vector3(EMPTY_M, 0, EMPTY_M)];
  }
  const axes = [0, 1, 2].map((axis) => Float64Array.from(lines.filter((_, i) => i % 3 === axis)).sort());
  const at = (share: number) => axes.map((values) => values[Math.round(share * (values.length - 1))]);
  const usual = [at(OUTLIERS), at(1 - OUTLIERS)].map((corner) => yUp(corner as unknown as Vec3));
  const box = new Box3().setFromPoints(usual);
  const ends = Array.from({ length: lines.length / 3 }, (_, i) =>
    yUp([...lines.subarray(3 * i, 3 * i + 3)] as unknown as Vec3),
  );
  return ends.filter((end) => box.containsPoint(end));
}

/** The cameras, too. */
export function withCameras(points: readonly Vector3[], centres: readonly Vec3[]): Vector3[] {
  return [...points, ...centres.map(yUp)];
}

/**
 * Where a camera stands that has all points in its picture, as large as can be, and the place in
 * their midst that it turns about.
 * @param towards from the points to the camera, of length one
 * @param tangents of half the angles of view, level and upright
 */
export function standFor(
  points: readonly Vector3[],
  towards: Vector3,
  tangents: readonly [level: number, upright: number],
): { position: Vector3; target: Vector3 } {
  const right = new Vector3(0, 1, 0).cross(towards).normalize();
  const up = towards.clone().cross(right);
  // A camera at (x, z) sees a point between its two rays: |p - x| <= tangent (z - depth of p).
  const [across, along] = [right, up].map((axis, i) => {
    const tangent = tangents[i] as number;
    let [high, low] = [Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY];
    for (const point of points) {
      const [place, depth] = [point.dot(axis), tangent * point.dot(towards)];
      high = Math.max(high, place + depth);
      low = Math.min(low, place - depth);
    }
    return { middle: (high + low) / 2, depth: (high - low) / (2 * tangent) };
  }) as [Fit, Fit];
  const midst = new Box3()
    .setFromPoints([...points])
    .getCenter(new Vector3())
    .dot(towards);
  const distance = Math.max(LEAST_DISTANCE_M, across.depth - midst, along.depth - midst);
  const target = new Vector3()
    .addScaledVector(right, across.middle)
    .addScaledVector(up, along.middle)
    .addScaledVector(towards, midst);
  return { position: target.clone().addScaledVector(towards, distance), target };
}

/** In one direction of the picture: where the camera stands in it, and how far out. */
interface Fit {
  middle: number;
  depth: number;
}

/** Windows of photographs and how alike they are. */
import { cross, dot, type Mat, unit } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { type Camera, mapped, planeHomography } from "./camera";
import { type Picture, sample } from "./house";

/** The grey values about a point, `size` by `size`. */
export function windowAt(picture: Picture, [x, y]: Vec2, size: number): number[] {
  const half = (size - 1) / 2;
  return offsets(half).map(([dx, dy]) => sample(picture, [x + dx, y + dy]));
}

/** The same in another photograph, each pixel where a homography takes it. */
export function warpedWindow(picture: Picture, H: Mat, [x, y]: Vec2, size: number): number[] {
  return offsets((size - 1) / 2).map(([dx, dy]) => sample(picture, mapped(H, [x + dx, y + dy])));
}

function offsets(half: number): Vec2[] {
  const all: Vec2[] = [];
  for (let dy = -half; dy <= half; dy += 1) {
    for (let dx = -half; dx <= half; dx += 1) {
      all.push([dx, dy]);
    }
  }
  return all;
}

export const meanOf = (values: readonly number[]): number =>
  values.reduce((sum, one) => sum + one, 0) / values.length;

/** Centred normalised cross-correlation, -1 to 1; 0 where a window is constant. */
export function ncc(a: readonly number[], b: readonly number[]): number {
  const [ma, mb] = [meanOf(a), meanOf(b)];
  let [ab, aa, bb] = [0, 0, 0];
  a.forEach((one, i) => {
    const [da, db] = [one - ma, (b[i] as number) - mb];
    ab += da * db;
    aa += da * da;
    bb += db * db;
  });
  const size = Math.sqrt(aa * bb);
  return size < 1e-9 ? 0 : ab / size;
}

/** Mean squared difference of grey values. */
export function meanSquare(a: readonly number[], b: readonly number[]): number {
  return meanOf(a.map((one, i) => (one - (b[i] as number)) ** 2));
}

/** The plane through a level line at an angle of theta against the horizontal: upwards on its left side. */
export function planeAt(line: readonly [Vec3, Vec3], theta: number): { n: Vec3; d: number } {
  const [p, q] = line;
  const along = unit([q[0] - p[0], q[1] - p[1], q[2] - p[2]]);
  const left = unit(cross([0, 0, 1], along));
  const n: Vec3 = [-Math.sin(theta) * left[0], -Math.sin(theta) * left[1], Math.cos(theta)];
  return { n, d: -dot(n, p) };
}

/** Points of interest beside a line: image points of the reference view, and their distances from the line, metres. */
export interface InterestPoint {
  x: Vec2;
  distance: number;
}

/** Sim(theta) of one pair: weighted mean of squared correlations (B99 4.1). */
export function similarity(
  from: { camera: Camera; picture: Picture },
  to: { camera: Camera; picture: Picture },
  line: readonly [Vec3, Vec3],
  theta: number,
  points: readonly InterestPoint[],
  size = 9,
): number {
  const { n, d } = planeAt(line, theta);
  const H = planeHomography(from.camera, to.camera, n, d);
  let [sum, weights] = [0, 0];
  for (const { x, distance } of points) {
    const score = ncc(windowAt(from.picture, x, size), warpedWindow(to.picture, H, x, size));
    sum += Math.max(0, score) ** 2 / distance;
    weights += 1 / distance;
  }
  return sum / weights;
}

/** The second derivative at the highest place of a curve (per square radian), its height, and its range. */
export function peakOf(angles: readonly number[], values: readonly number[]) {
  const best = values.reduce((most, one, i) => (one > (values[most] as number) ? i : most), 0);
  const step = (angles[1] as number) - (angles[0] as number);
  const i = Math.min(Math.max(best, 1), values.length - 2);
  const [before, at, after] = [values[i - 1], values[i], values[i + 1]] as [number, number, number];
  return {
    theta: angles[best] as number,
    height: values[best] as number,
    curvature: Math.abs((before - 2 * at + after) / step ** 2),
    amplitude: (values[best] as number) - Math.min(...values),
  };
}

/** Grey values with another brightness and contrast. */
export const relit = (values: readonly number[], gain: number, offset: number): number[] =>
  values.map((one) => gain * one + offset);

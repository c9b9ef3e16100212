/** Lines in space from lines in images. */
import {
  add,
  apply3,
  dot,
  inverse,
  lineDistance,
  lineThrough,
  type Mat,
  outer,
  scaled,
  sub,
  sum,
  times,
  transpose,
} from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { type Camera, imageOf, meetOfPlanes, planeOfLine, projection } from "./camera";

export type Ends2 = readonly [Vec2, Vec2];
export type Ends3 = readonly [Vec3, Vec3];

/** Where a line in space is seen. */
export const inView = (camera: Camera, [p, q]: Ends3): Ends2 => [imageOf(camera, p), imageOf(camera, q)];

/** The line in space of a line in each of two views; `sine` of the angle of their planes says how well. */
export function lineOfTwo(cameras: readonly [Camera, Camera], lines: readonly [Ends2, Ends2]) {
  const [one, other] = cameras.map((camera, i) =>
    planeOfLine(projection(camera), lineThrough(...(lines[i] as Ends2))),
  ) as [ReturnType<typeof planeOfLine>, ReturnType<typeof planeOfLine>];
  return meetOfPlanes(one, other);
}

/** The part of a line in space between two values of a coordinate. */
export function partBetween(
  { point, direction }: { point: Vec3; direction: Vec3 },
  axis: 0 | 1 | 2,
  from: number,
  to: number,
): Ends3 {
  const at = (value: number) => add(point, scaled(direction, (value - point[axis]) / direction[axis]));
  return [at(from), at(to)];
}

/** Where the line of two views is seen in a third. */
export function predicted(
  cameras: readonly [Camera, Camera],
  lines: readonly [Ends2, Ends2],
  third: Camera,
): Vec3 {
  const { point, direction } = lineOfTwo(cameras, lines);
  return lineThrough(imageOf(third, point), imageOf(third, add(point, direction)));
}

/**
 * The trifocal tensor with the third view first: the coefficient i of its line is l'T T_i l'', of the lines in the two others.
 * In a frame where the first matrix is [I | 0], T_i = a_i b_4T - a_4 b_iT.
 */
export function trifocal(P: Mat, other: Mat, third: Mat): readonly [Mat, Mat, Mat] {
  const A = P.map((row) => row.slice(0, 3));
  const a = P.map((row) => row[3] as number);
  const back = inverse(A);
  const shift = apply3(back, a);
  // The inverse of [A a; 0 1]: times that, the first matrix is [I | 0].
  const moving = [...back.map((row, i) => [...row, -(shift[i] as number)]), [0, 0, 0, 1]];
  const [B, D] = [other, third].map((M) => transpose(times(M, moving))) as [Mat, Mat];
  const [b4, d4] = [B[3], D[3]] as [Mat[number], Mat[number]];
  return [0, 1, 2].map((i) =>
    sum(outer(B[i] as Mat[number], d4), outer(b4, D[i] as Mat[number]), -1),
  ) as unknown as readonly [Mat, Mat, Mat];
}

export function transferredLine(T: readonly [Mat, Mat, Mat], line: Vec3, other: Vec3): Vec3 {
  return T.map((one) => dot(line, apply3(one, other))) as unknown as Vec3;
}

/** Root of the mean squared distance, pixels, from measured ends to the images of a line in space (B99 3.2, figure 4). */
export function lineError(cameras: readonly Camera[], measured: readonly Ends2[], [p, q]: Ends3): number {
  const squares = cameras.flatMap((camera, i) => {
    const line = lineThrough(imageOf(camera, p), imageOf(camera, q));
    return (measured[i] as Ends2).map((x) => lineDistance(line, x) ** 2);
  });
  return Math.sqrt(squares.reduce((sum, one) => sum + one, 0) / squares.length);
}

/** Least distance between two rays, and the points on them. */
export function nearestOnRays(a: Ends3, b: Ends3): Ends3 {
  const [u, v, w] = [sub(a[1], a[0]), sub(b[1], b[0]), sub(a[0], b[0])];
  const [uu, uv, vv, uw, vw] = [dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)];
  const of = uu * vv - uv * uv;
  return [add(a[0], scaled(u, (uv * vw - vv * uw) / of)), add(b[0], scaled(v, (uu * vw - uv * uw) / of))];
}

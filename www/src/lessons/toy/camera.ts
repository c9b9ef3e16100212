/** Pinhole cameras of the toy scene, in the conventions of the core: x_cam = R (X - C), z forward; image x right, y down. */
import {
  add,
  apply3,
  cross,
  crossMatrix,
  dot,
  homogeneous,
  inverse,
  type Mat,
  norm,
  point2,
  scaled,
  sub,
  times,
  transpose,
  unit,
} from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";

export interface Camera {
  /** Principal distance, pixels. */
  f: number;
  /** Principal point, pixels. */
  cx: number;
  cy: number;
  width: number;
  height: number;
  R: Mat;
  C: Vec3;
}

/** Rotation of a camera at C that looks at a target, with `up` upwards in its image. */
export function lookingAt(C: Vec3, target: Vec3, up: Vec3): Mat {
  const z = unit(sub(target, C));
  const x = unit(cross(z, up));
  return [x, cross(z, x), z];
}

export function calibration({ f, cx, cy }: Camera): Mat {
  return [
    [f, 0, cx],
    [0, f, cy],
    [0, 0, 1],
  ];
}

/** P = K [R | -R C], 3 x 4. */
export function projection(camera: Camera): Mat {
  const KR = times(calibration(camera), camera.R);
  const last = apply3(KR, camera.C);
  return KR.map((row, i) => [...row, -(last[i] as number)]);
}

/** P X, homogeneous: the third number is the depth where P = K [R | -R C]. */
export function projected(P: Mat, X: Vec3): Vec3 {
  return apply3(P, [...X, 1]);
}

/** Where a point is seen, pixels. */
export function imageOf(camera: Camera, X: Vec3): Vec2 {
  return point2(projected(projection(camera), X));
}

/** The direction in which an image point is seen, of depth 1. */
export function rayOf(camera: Camera, x: Vec2): Vec3 {
  return apply3(transpose(camera.R), apply3(inverse(calibration(camera)), homogeneous(x)));
}

/** The point at a depth along the ray of an image point. */
export function atDepth(camera: Camera, x: Vec2, depth: number): Vec3 {
  return add(camera.C, scaled(rayOf(camera, x), depth));
}

/** The point at a height along the ray of an image point. */
export function atHeight(camera: Camera, x: Vec2, height: number): Vec3 {
  return pointAtHeight(projection(camera), x, height);
}

/** Depth of a point before a camera. */
export function depthOf(camera: Camera, X: Vec3): number {
  return dot(camera.R[2] as unknown as Vec3, sub(X, camera.C));
}

/** The parts A = K R and a = -K R C of P = [A | a]. */
export function partsOf(P: Mat): { A: Mat; a: Vec3 } {
  return {
    A: P.map((row) => row.slice(0, 3)),
    a: P.map((row) => row[3] as number) as unknown as Vec3,
  };
}

/** The projection centre of P. */
export function centreOf(P: Mat): Vec3 {
  const { A, a } = partsOf(P);
  return scaled(apply3(inverse(A), a), -1);
}

/** F with x'ᵀ F x = 0: [e']x A' A⁻¹, of two projection matrices. */
export function fundamental(P: Mat, other: Mat): Mat {
  const { A } = partsOf(P);
  const { A: A2 } = partsOf(other);
  const epipole = projected(other, centreOf(P));
  const F = times(crossMatrix(scaled(epipole, 1 / norm(epipole))), times(A2, inverse(A)));
  const size = Math.hypot(...F.flat());
  return F.map((row) => row.map((one) => one / size));
}

/** The plane (n, d), nᵀX + d = 0, of all points seen on an image line: Pᵀ l. */
export function planeOfLine(P: Mat, line: Vec3): { n: Vec3; d: number } {
  const { A, a } = partsOf(P);
  const n = apply3(transpose(A), line);
  const size = norm(n);
  return { n: scaled(n, 1 / size), d: dot(line, a) / size };
}

/** A point and the direction of the line in which two planes meet. */
export function meetOfPlanes(
  one: { n: Vec3; d: number },
  other: { n: Vec3; d: number },
): { point: Vec3; direction: Vec3; sine: number } {
  const across = cross(one.n, other.n);
  const sine = norm(across);
  const point = scaled(
    add(scaled(cross(other.n, across), -one.d), scaled(cross(across, one.n), -other.d)),
    1 / sine ** 2,
  );
  return { point, direction: scaled(across, 1 / sine), sine };
}

/** The homography of a plane nᵀX + d = 0, from the image of one camera to that of the other. */
export function planeHomography(from: Camera, to: Camera, n: Vec3, d: number): Mat {
  // Seen from the first camera: X = C + s r, s = -(nᵀC + d) / (nᵀr).
  const at = dot(n, from.C) + d;
  const toRay = times(transpose(from.R), inverse(calibration(from)));
  const { A, a } = partsOf(projection(to));
  // x' ~ A (C nᵀr - at r) + a nᵀr, linear in r.
  const moved = add(apply3(A, from.C), a);
  const rows = A.map((row, i) =>
    [0, 1, 2].map((j) => (moved[i] as number) * (n[j] as number) - at * (row[j] as number)),
  );
  const H = times(rows, toRay);
  const last = (H[2] as readonly number[])[2] as number;
  return H.map((row) => row.map((one) => one / last));
}

export const mapped = (H: Mat, x: Vec2): Vec2 => point2(apply3(H, homogeneous(x)));

/** The point at a height on the ray of an image point, of a projection matrix. */
export function pointAtHeight(P: Mat, x: Vec2, height: number): Vec3 {
  const { A } = partsOf(P);
  const centre = centreOf(P);
  const ray = apply3(inverse(A), homogeneous(x));
  return add(centre, scaled(ray, (height - centre[2]) / ray[2]));
}

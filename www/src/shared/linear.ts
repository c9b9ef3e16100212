/** Small vectors and matrices, in plain arrays, and rings of places in plan. */
import type { Vec2, Vec3 } from "./records";

/** Rows. */
export type Mat = readonly (readonly number[])[];
type Vector = readonly number[];

export const DEGREE = Math.PI / 180;

export function dot(a: Vector, b: Vector): number {
  let sum = 0;
  for (let i = 0; i < a.length; i += 1) {
    sum += (a[i] as number) * (b[i] as number);
  }
  return sum;
}

/** a + times b. Three numbers are written out: photographs of the lessons are made ray by ray. */
export function add<V extends Vector>(a: V, b: Vector, times = 1): V {
  if (a.length !== 3) {
    return a.map((one, i) => one + times * (b[i] as number)) as unknown as V;
  }
  const p = a as unknown as Vec3;
  const q = b as unknown as Vec3;
  return [p[0] + times * q[0], p[1] + times * q[1], p[2] + times * q[2]] as unknown as V;
}

export const sub = <V extends Vector>(a: V, b: Vector): V => add(a, b, -1);

export const scaled = <V extends Vector>(a: V, by: number): V => a.map((one) => one * by) as unknown as V;

export const norm = (a: Vector): number => Math.hypot(...a);
export const unit = <V extends Vector>(a: V): V => scaled(a, 1 / norm(a));

export function cross(a: Vector, b: Vector): Vec3 {
  const p = a as unknown as Vec3;
  const q = b as unknown as Vec3;
  return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
}

export const distance2 = (a: Vec2, b: Vec2): number => Math.hypot(a[0] - b[0], a[1] - b[1]);
/** Between two numbers at a fraction. */
export const mix = (a: number, b: number, t: number): number => a + t * (b - a);
export const mix3 = (a: Vec3, b: Vec3, t: number): Vec3 => add(a, scaled(sub(b, a), t));
export const clamp = (value: number, least: number, most: number): number =>
  Math.min(most, Math.max(least, value));

export function transpose(a: Mat): Mat {
  return (a[0] ?? []).map((_, column) => a.map((row) => row[column] as number));
}

export function times(a: Mat, b: Mat): Mat {
  const columns = transpose(b);
  return a.map((row) => columns.map((column) => dot(row, column)));
}

export function apply(a: Mat, v: Vector): number[] {
  return a.map((row) => dot(row, v));
}

export const apply3 = (a: Mat, v: Vector): Vec3 => apply(a, v) as unknown as Vec3;

/** a + factor times b. */
export const sum = (a: Mat, b: Mat, factor = 1): Mat => a.map((row, i) => add(row, b[i] as Vector, factor));

/** a bᵀ */
export const outer = (a: Vector, b: Vector): Mat => a.map((x) => scaled(b, x));

/** [v]x: the matrix of the cross product with v. */
export const crossMatrix = ([x = 0, y = 0, z = 0]: Vector): Mat => [
  [0, -z, y],
  [z, 0, -x],
  [-y, x, 0],
];

/** Of a 3 x 3 matrix. */
export function determinant([r = [], s = [], t = []]: Mat): number {
  return dot(r, cross(s, t));
}

/** Of a 3 x 3 matrix. */
export function inverse(a: Mat): Mat {
  const [r = [], s = [], t = []] = a;
  const of = determinant(a);
  return transpose([scaled(cross(s, t), 1 / of), scaled(cross(t, r), 1 / of), scaled(cross(r, s), 1 / of)]);
}

/** The image point of a homogeneous one. */
export const point2 = ([x, y, w]: Vec3): Vec2 => [x / w, y / w];
export const homogeneous = ([x, y]: Vec2): Vec3 => [x, y, 1];

/** Distance of a point from a line (a, b, c), in the units of the point. */
export function lineDistance(line: Vec3, at: Vec2): number {
  return Math.abs(dot(line, homogeneous(at))) / Math.hypot(line[0], line[1]);
}

export const lineThrough = (a: Vec2, b: Vec2): Vec3 => cross(homogeneous(a), homogeneous(b));

/** The part of a line inside a rectangle from (0, 0); null where it misses it. */
export function clipLine([a, b, c]: Vec3, width: number, height: number): readonly [Vec2, Vec2] | null {
  const hits: Vec2[] = [];
  for (const x of [0, width]) {
    const y = -(a * x + c) / b;
    if (y >= 0 && y <= height) hits.push([x, y]);
  }
  for (const y of [0, height]) {
    const x = -(b * y + c) / a;
    if (x >= 0 && x <= width) hits.push([x, y]);
  }
  const first = hits[0];
  const last = hits.reduce<Vec2 | undefined>(
    (best, one) =>
      first !== undefined && (best === undefined || distance2(one, first) > distance2(best, first))
        ? one
        : best,
    undefined,
  );
  return first === undefined || last === undefined || distance2(first, last) < 1e-9 ? null : [first, last];
}

/** Eigenvalues (larger first) of a symmetric 2 x 2 matrix, and the direction of the first, radians. */
export function ellipseOf(a: number, b: number, d: number): { major: number; minor: number; angle: number } {
  const mean = (a + d) / 2;
  const half = Math.hypot((a - d) / 2, b);
  return {
    major: Math.sqrt(Math.max(0, mean + half)),
    minor: Math.sqrt(Math.max(0, mean - half)),
    angle: Math.atan2(2 * b, a - d) / 2,
  };
}

/** The thing of least distance, of those that are within reach; null where none is. */
export function nearestOf<T>(all: readonly T[], distance: (one: T) => number, reach: number): T | null {
  const near = all.map((one) => ({ one, at: distance(one) })).filter(({ at }) => at <= reach);
  return near.sort((a, b) => a.at - b.at)[0]?.one ?? null;
}

/** The frame of an angle about a line (B99 4.1): level and away to the left of it, seen from above, and upwards across both. */
export function thetaFrame(p: Vector, q: Vector): { along: Vec3; left: Vec3; up: Vec3 } {
  const along = unit(sub(q as unknown as Vec3, p));
  const left = unit<Vec3>([-along[1], along[0], 0]);
  return { along, left, up: cross(along, left) };
}

/** The parameter at which a curve comes nearest to a point, to a 400th of its range. */
export function nearestParameter(curve: (t: number) => Vec2, from: number, to: number, at: Vec2): number {
  let best = { t: from, by: Number.POSITIVE_INFINITY };
  for (let i = 0; i <= 400; i += 1) {
    const t = mix(from, to, i / 400);
    const by = distance2(curve(t), at);
    if (by < best.by) {
      best = { t, by };
    }
  }
  return best.t;
}

/** The same numbers, or other things, with one of them replaced. */
export const replaced = <P extends readonly unknown[]>(all: P, at: number, by: P[number]): P =>
  all.with(at, by) as unknown as P;

/** The corners of a rectangle in plan, counter-clockwise. */
export const rectangle = ([x0, y0]: Vec2, [x1, y1]: Vec2): readonly [Vec2, Vec2, Vec2, Vec2] => [
  [x0, y0],
  [x1, y0],
  [x1, y1],
  [x0, y1],
];

/** The corners of a ring, each with the next. */
export function edgesOf<T>(ring: readonly T[]): (readonly [T, T])[] {
  return ring.map((corner, i) => [corner, ring[(i + 1) % ring.length] as T]);
}

/** Even-odd rule, in plan. */
export function isInside([x = 0, y = 0]: Vector, ring: Mat): boolean {
  return ring.reduce((inside, [ax = 0, ay = 0], i) => {
    const [bx = 0, by = 0] = ring[(i + 1) % ring.length] ?? [];
    return ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax) ? !inside : inside;
  }, false);
}

/** The least and largest coordinates of places. */
export function boundsOf(places: Mat): [x0: number, y0: number, x1: number, y1: number] {
  const [xs, ys] = [places.map(([x = 0]) => x), places.map(([, y = 0]) => y)];
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** In plan; positive where the ring runs counter-clockwise. */
export function planArea(ring: Mat): number {
  return edgesOf(ring).reduce(
    (sum, [[ax = 0, ay = 0], [bx = 0, by = 0]]) => sum + (ax * by - bx * ay) / 2,
    0,
  );
}

/** Normal of a ring in space, as long as its area is large. */
export function areaVector(ring: readonly Vec3[]): Vec3 {
  const [first = [0, 0, 0]] = ring;
  return edgesOf(ring).reduce<Vec3>(
    (sum, [p, q]) => add(sum, cross(sub(p, first), sub(q, first)), 0.5),
    [0, 0, 0],
  );
}

/** Small vectors and matrices: rows of numbers. */
export type Vec2 = readonly [number, number];
export type Vec3 = readonly [number, number, number];
/** Rows. */
export type Mat = readonly (readonly number[])[];

export const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scaled = (a: Vec3, by: number): Vec3 => [a[0] * by, a[1] * by, a[2] * by];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const norm = (a: Vec3): number => Math.hypot(...a);
export const unit = (a: Vec3): Vec3 => scaled(a, 1 / norm(a));
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
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
  return a.map((row) =>
    columns.map((column) => row.reduce((sum, one, i) => sum + one * (column[i] ?? 0), 0)),
  );
}

export function apply(a: Mat, v: readonly number[]): number[] {
  return a.map((row) => row.reduce((sum, one, i) => sum + one * (v[i] ?? 0), 0));
}

export const apply3 = (a: Mat, v: readonly number[]): Vec3 => apply(a, v) as unknown as Vec3;

/** [v]x: the matrix of the cross product with v. */
export const crossMatrix = ([x, y, z]: Vec3): Mat => [
  [0, -z, y],
  [z, 0, -x],
  [-y, x, 0],
];

export function determinant(a: Mat): number {
  const [r, s, t] = a as unknown as readonly [Vec3, Vec3, Vec3];
  return dot(r, cross(s, t));
}

export function inverse(a: Mat): Mat {
  const [r, s, t] = a as unknown as readonly [Vec3, Vec3, Vec3];
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

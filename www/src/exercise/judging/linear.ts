/** The linear algebra of the exercises: small, and in the plain arrays that a student writes. */

/** Rows of numbers. */
export type Matrix = readonly (readonly number[])[];
export type Vector = readonly number[];

export function dot(a: Vector, b: Vector): number {
  return a.reduce((sum, value, i) => sum + value * (b[i] ?? Number.NaN), 0);
}

export function transposed(a: Matrix): number[][] {
  return (a[0] ?? []).map((_, column) => a.map((row) => row[column] ?? Number.NaN));
}

export function product(a: Matrix, b: Matrix): number[][] {
  const columns = transposed(b);
  return a.map((row) => columns.map((column) => dot(row, column)));
}

export function applied(a: Matrix, v: Vector): number[] {
  return a.map((row) => dot(row, v));
}

export function sum(a: Matrix, b: Matrix, factor = 1): number[][] {
  return a.map((row, i) => row.map((value, j) => value + factor * (b[i]?.[j] ?? Number.NaN)));
}

/** a bᵀ */
export function outer(a: Vector, b: Vector): number[][] {
  return a.map((x) => b.map((y) => x * y));
}

/** [v]×, so that [v]× w = v × w. */
export function crossMatrix([x = 0, y = 0, z = 0]: Vector): number[][] {
  return [
    [0, -z, y],
    [z, 0, -x],
    [-y, x, 0],
  ];
}

/** Of a 3 x 3 matrix. */
export function determinant([a = [], b = [], c = []]: Matrix): number {
  return dot(a, applied(crossMatrix(b), c));
}

/** Of a 3 x 3 matrix. */
export function inverse(matrix: Matrix): number[][] {
  const [a = [], b = [], c = []] = matrix;
  const scale = 1 / determinant(matrix);
  const columns = [applied(crossMatrix(b), c), applied(crossMatrix(c), a), applied(crossMatrix(a), b)];
  return transposed(columns).map((row) => row.map((value) => value * scale));
}

/** The centre of a 3 x 4 projection, homogeneous: P C = 0. */
export function centreOf(projection: Matrix): number[] {
  return [0, 1, 2, 3].map((left) => {
    const minor = projection.map((row) => row.filter((_, column) => column !== left));
    return (left % 2 === 0 ? 1 : -1) * determinant(minor);
  });
}

/** P⁺ = Pᵀ (P Pᵀ)⁻¹ of a 3 x 4 projection. */
export function pseudoInverse(projection: Matrix): number[][] {
  return product(transposed(projection), inverse(product(projection, transposed(projection))));
}

/** The least squares solution of A x = b, by the normal equations of three unknowns. */
export function leastSquares(a: Matrix, b: Vector): number[] {
  const t = transposed(a);
  return applied(inverse(product(t, a)), applied(t, b));
}

/** From homogeneous to image coordinates. */
export function dehomogenised([x = 0, y = 0, w = 0]: Vector): [number, number] {
  return [x / w, y / w];
}

/** Do two matrices differ by nothing but a factor? */
export function isSameUpToScale(a: Matrix, b: Matrix, tolerance = 1e-6): boolean {
  const [u, v] = [a.flat(), b.flat()];
  const [sizeU, sizeV] = [Math.hypot(...u), Math.hypot(...v)];
  if (!(sizeU > 0 && sizeV > 0)) {
    return sizeU === sizeV;
  }
  return Math.abs(Math.abs(dot(u, v)) / (sizeU * sizeV) - 1) < tolerance * tolerance * 10;
}

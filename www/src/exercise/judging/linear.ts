/** The linear algebra of the exercises beyond that of all pages: in the plain arrays that a student writes. */
import {
  apply,
  crossMatrix,
  determinant,
  dot,
  inverse,
  type Mat,
  times,
  transpose,
} from "../../shared/linear";

export type Vector = readonly number[];

/** The centre of a 3 x 4 projection, homogeneous: P C = 0. */
export function centreOf(projection: Mat): Vector {
  return [0, 1, 2, 3].map((left) => {
    const minor = projection.map((row) => row.filter((_, column) => column !== left));
    return (left % 2 === 0 ? 1 : -1) * determinant(minor);
  });
}

/** P⁺ = Pᵀ (P Pᵀ)⁻¹ of a 3 x 4 projection. */
export function pseudoInverse(projection: Mat): Mat {
  return times(transpose(projection), inverse(times(projection, transpose(projection))));
}

/** F of two projections: [e′]× P′ P⁺ */
export function fundamental(p: Mat, q: Mat): Mat {
  return times(crossMatrix(apply(q, centreOf(p))), times(q, pseudoInverse(p)));
}

/** The least squares solution of A x = b, by the normal equations of three unknowns. */
export function leastSquares(a: Mat, b: Vector): Vector {
  const t = transpose(a);
  return apply(inverse(times(t, a)), apply(t, b));
}

/** From homogeneous to image coordinates. */
export function dehomogenised([x = 0, y = 0, w = 0]: Vector): [number, number] {
  return [x / w, y / w];
}

/** How far two vectors are apart; of other lengths they are no number apart. */
export function distance(a: Vector, b: Vector): number {
  return Math.hypot(...a.map((value, i) => value - (b[i] ?? Number.NaN)));
}

/** Do two matrices differ by nothing but a factor? */
export function isSameUpToScale(a: Mat, b: Mat, tolerance = 1e-6): boolean {
  const [u, v] = [a.flat(), b.flat()];
  const [sizeU, sizeV] = [Math.hypot(...u), Math.hypot(...v)];
  if (!(sizeU > 0 && sizeV > 0)) {
    return sizeU === sizeV;
  }
  return Math.abs(Math.abs(dot(u, v)) / (sizeU * sizeV) - 1) < tolerance * tolerance * 10;
}

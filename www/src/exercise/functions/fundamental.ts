/** F from two projections, as every epipolar beam of B99 3.1 needs it. */
import { apply, crossMatrix, type Mat, times, transpose } from "../../shared/linear";
import { functionExercise, matrixProblem } from "../judging/judge";
import { centreOf, fundamental, isSameUpToScale, pseudoInverse } from "../judging/linear";
import { plantedCamera, plantedPoint, seen } from "../judging/random";

type Input = readonly [p: Mat, q: Mat];

const POINTS = 10;

export const fundamentalFromProjections = functionExercise<Input, Mat>({
  name: "fundamentalFromProjections",
  title: "The fundamental matrix of two views",
  lesson: "epipolar",
  source: "B99 3.1",
  text: "Given the 3 × 4 projections P and P′ of two views, return the [[fundamental-matrix]] F (3 × 3) with x′ᵀ F x = 0 for all points x of the one view and x′ of the other that show the same point in space. Its scale is free. (C with P C = 0 is the first centre, e′ = P′ C the epipole, and P⁺ the pseudo-inverse of P.)",
  starter: `/** @param {number[][]} P  3 rows of 4; Q is P'. */
function fundamentalFromProjections(P, Q) {
  // Three rows of three numbers.
  return [];
}
`,
  solution: `function fundamentalFromProjections(P, Q) {
  const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
  const times = (A, B) => A.map((row) => B[0].map((_, j) => dot(row, B.map((other) => other[j]))));
  const T = (A) => A[0].map((_, j) => A.map((row) => row[j]));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const det = ([a, b, c]) => dot(a, cross(b, c));
  const inverse = (A) => {
    const [a, b, c] = A;
    return T([cross(b, c), cross(c, a), cross(a, b)]).map((row) => row.map((v) => v / det(A)));
  };
  const C = [0, 1, 2, 3].map((k) => (-1) ** k * det(P.map((row) => row.filter((_, j) => j !== k))));
  const e = Q.map((row) => dot(row, C));
  const plus = times(T(P), inverse(times(P, T(P))));
  const skew = [[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]];
  return times(skew, times(Q, plus));
}
`,
  unit: "px",
  limit: 1e-3,
  plant: (random) => {
    const [first, second] = [plantedCamera(random), plantedCamera(random)];
    const points = Array.from({ length: POINTS }, () => plantedPoint(random));
    const pairs = points.map(
      (point) => [seen(first.projection, point), seen(second.projection, point)] as const,
    );
    return {
      input: [first.projection, second.projection],
      // Distance of x′ from the line F x.
      error: (f) =>
        Math.max(
          ...pairs.map(([x, y]) => {
            const [a = 0, b = 0, c = 0] = apply(f, [...x, 1]);
            return Math.abs(a * y[0] + b * y[1] + c) / Math.hypot(a, b);
          }),
        ),
    };
  },
  formProblem: (answer) => matrixProblem(answer, 3, 3),
  isSame: isSameUpToScale,
  mistakes: {
    transposed: {
      says: "This is Fᵀ: it holds for xᵀ F x′ = 0. Here x, of the view of P, stands on the right, so that F x is a line of the view of P′.",
      variants: [(p, q) => transpose(fundamental(p, q))],
    },
    "no cross product": {
      says: "This is P′ P⁺ alone, which maps points to points. The line through the epipole and that point is their cross product: multiply by [e′]× from the left.",
      variants: [(p, q) => times(q, pseudoInverse(p))],
    },
    "transpose for pseudo-inverse": {
      says: "Pᵀ stands in the place of P⁺. P is not orthogonal: P⁺ = Pᵀ (P Pᵀ)⁻¹.",
      variants: [(p, q) => times(crossMatrix(apply(q, centreOf(p))), times(q, transpose(p)))],
    },
    "wrong epipole": {
      says: "The epipole is that of the other view: e = P C′. All lines F x lie in the second view and meet in e′ = P′ C, the image of the first centre.",
      variants: [(p, q) => times(crossMatrix(apply(p, centreOf(q))), times(q, pseudoInverse(p)))],
    },
    "wrong sign": {
      says: "[e′]× is antisymmetric: what stands above the diagonal has the opposite sign below it.",
      variants: [
        (p, q) => {
          const skew = crossMatrix(apply(q, centreOf(p))).map((row) => row.map(Math.abs));
          return times(skew, times(q, pseudoInverse(p)));
        },
        (p, q) => {
          const skew = crossMatrix(apply(q, centreOf(p)));
          const mirrored = skew.map((row, i) => row.map((value, j) => (j > i ? value : (skew[j]?.[i] ?? 0))));
          return times(mirrored, times(q, pseudoInverse(p)));
        },
      ],
    },
    "everything is zero": {
      says: "P′ C′ is zero: the centre of a view has no image in that view itself. Take C, the centre of P.",
      variants: [
        () => [
          [0, 0, 0],
          [0, 0, 0],
          [0, 0, 0],
        ],
      ],
    },
  },
});

/** How well a point is known that two views show: B99 figure 9, "accuracy against the number of views". */
import { dot, inverse, type Mat, sum, times, transpose } from "../../shared/linear";
import { functionExercise, matrixProblem } from "../judging/judge";
import type { Vector } from "../judging/linear";
import { between, plantedCamera, plantedPoint } from "../judging/random";

type Input = readonly [projections: readonly Mat[], x: Vector, sigma: number];

/** The derivatives of [u, v] by X: two rows of three. */
function jacobian(p: Mat, x: Vector): Mat {
  const [a = 0, b = 0, w = 1] = p.map((row) => dot(row, [...x, 1]));
  return [a / w, b / w].map((at, i) => [0, 1, 2].map((k) => ((p[i]?.[k] ?? 0) - at * (p[2]?.[k] ?? 0)) / w));
}

/** Σ Jᵀ J over the views */
function information(projections: readonly Mat[], x: Vector, of = jacobian): Mat {
  return projections
    .map((p) => of(p, x))
    .map((j) => times(transpose(j), j))
    .reduce((all, one) => sum(all, one));
}

const scaled = (a: Mat, by: number): Mat => a.map((row) => row.map((value) => value * by));

function covariance(projections: readonly Mat[], x: Vector, sigma: number): Mat {
  return scaled(inverse(information(projections, x)), sigma ** 2);
}

export const covarianceOfPoint = functionExercise<Input, Mat>({
  name: "covarianceOfPoint",
  title: "How well a point is known",
  lesson: "triangulation",
  source: "B99 3.4, figure 9",
  text: "A point X is seen by two or more views with the projections Ps (3 × 4 each). In each of them u and v are measured with the standard deviation σ, in pixels, independently. Return the 3 × 3 [[covariance]] of X in m²: (Σ Jᵀ J / σ²)⁻¹, where J has the derivatives of u and v by the three coordinates of X. With u = (p₁ · X) / (p₃ · X), ∂u/∂X is (p₁ − u p₃) / (p₃ · X), of their first three elements.",
  starter: `/** @param {number[][][]} Ps  projections;  @param {number[]} X  3 numbers;  @param {number} sigma  px */
function covarianceOfPoint(Ps, X, sigma) {
  // Three rows of three numbers.
  return [];
}
`,
  solution: `function covarianceOfPoint(Ps, X, sigma) {
  const N = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (const P of Ps) {
    const [a, b, w] = P.map((p) => p[0] * X[0] + p[1] * X[1] + p[2] * X[2] + p[3]);
    for (const [row, at] of [[P[0], a / w], [P[1], b / w]]) {
      const j = [0, 1, 2].map((k) => (row[k] - at * P[2][k]) / w);
      j.forEach((v, m) => j.forEach((u, n) => (N[m][n] += (v * u) / sigma ** 2)));
    }
  }
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const [a, b, c] = N;
  const det = a.reduce((sum, v, i) => sum + v * cross(b, c)[i], 0);
  const columns = [cross(b, c), cross(c, a), cross(a, b)];
  return [0, 1, 2].map((i) => columns.map((column) => column[i] / det));
}
`,
  unit: "of the largest variance",
  limit: 1e-4,
  plant: (random) => {
    const point = plantedPoint(random);
    const count = 2 + Math.floor(3 * random());
    const projections = Array.from({ length: count }, () => plantedCamera(random).projection);
    const sigma = between(random, 0.2, 0.6);
    const planted = covariance(projections, point, sigma);
    const largest = Math.max(...planted.flat().map(Math.abs));
    return {
      input: [projections, point, sigma],
      error: (answer) => Math.max(...sum(answer, planted, -1).flat().map(Math.abs)) / largest,
    };
  },
  formProblem: (answer) => matrixProblem(answer, 3, 3),
  isSame: (a, b) => {
    const size = Math.max(...a.flat().map(Math.abs));
    return Math.max(...sum(a, b, -1).flat().map(Math.abs)) <= 1e-5 * size;
  },
  mistakes: {
    "standard deviation for variance": {
      says: "σ stands where σ² should. A covariance is made of variances: pixels squared become metres squared.",
      variants: [(ps, x, sigma) => scaled(inverse(information(ps, x)), sigma)],
    },
    "σ forgotten": {
      says: "This is the covariance for measurements of one pixel: the standard deviation of the images is not in it.",
      variants: [(ps, x) => inverse(information(ps, x))],
    },
    "not inverted": {
      says: "This is Σ Jᵀ J / σ², the information: it grows with every view. The covariance is its inverse.",
      variants: [
        (ps, x, sigma) => scaled(information(ps, x), sigma ** -2),
        (ps, x, sigma) => scaled(information(ps, x), sigma ** 2),
      ],
    },
    "σ on the wrong side": {
      says: "The covariance is divided by σ², not multiplied: worse images make better points.",
      variants: [(ps, x, sigma) => scaled(inverse(information(ps, x)), sigma ** -2)],
    },
    "derivative of the numerator alone": {
      says: "The derivative of u is (p₁ − u p₃) / w: what p₃ adds, the change of the depth, is missing.",
      variants: [
        (ps, x, sigma) => {
          const j = (p: Mat, at: Vector) => {
            const w = dot(p[2] ?? [], [...at, 1]);
            return [0, 1].map((i) => [0, 1, 2].map((k) => (p[i]?.[k] ?? 0) / w));
          };
          return scaled(inverse(information(ps, x, j)), sigma ** 2);
        },
      ],
    },
    "not divided by the depth": {
      says: "The derivatives are not divided by p₃ · X: the point is as well known as if it were 1 m away.",
      variants: [
        (ps, x, sigma) => {
          const j = (p: Mat, at: Vector) => scaled(jacobian(p, at), dot(p[2] ?? [], [...at, 1]));
          return scaled(inverse(information(ps, x, j)), sigma ** 2);
        },
      ],
    },
    "mean over the views": {
      says: "The information of the views is averaged, not added: then a further view would not help.",
      variants: [
        (ps, x, sigma) => scaled(covariance(ps, x, sigma), ps.length),
        (ps, x, sigma) => scaled(covariance(ps, x, sigma), 2 * ps.length),
      ],
    },
  },
});

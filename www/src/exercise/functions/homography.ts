/** The homography that a plane induces between two views: H(theta) of B99 4.1. */
import {
  add,
  apply,
  dot,
  inverse,
  type Mat,
  outer,
  scaled,
  sub,
  sum,
  times,
  transpose,
} from "../../shared/linear";
import { functionExercise, matrixProblem } from "../judging/judge";
import { dehomogenised, distance, isSameUpToScale, type Vector } from "../judging/linear";
import { between, plantedCamera } from "../judging/random";

type Input = readonly [k: Mat, kOther: Mat, r: Mat, t: Vector, n: Vector, d: number];

const POINTS = 8;

/** K′ (R + t nᵀ / d) K⁻¹ */
function homography(k: Mat, kOther: Mat, r: Mat, t: Vector, n: Vector, d: number, sign = 1): Mat {
  return times(kOther, times(sum(r, outer(t, n), sign / d), inverse(k)));
}

/** The same images, in coordinates that are shifted by half a pixel. */
function shift(by: number): Mat {
  return [
    [1, 0, by],
    [0, 1, by],
    [0, 0, 1],
  ];
}

export const homographyOfPlane = functionExercise<Input, Mat>({
  name: "homographyOfPlane",
  title: "The homography of a plane",
  lesson: "homography",
  source: "B99 4.1",
  text: "The first camera is K [I | 0], the second K′ [R | t]: a point X of the first camera's frame is R X + t in that of the second. Given a plane n · X = d in the first camera's frame, return the [[homography]] H (3 × 3) that takes the image x of each of its points to x′ ≃ H x. Its scale is free. (On the plane n · X / d is 1, so that R X + t = (R + t nᵀ / d) X.)",
  starter: `/** @param {number[][]} K  3 rows of 3, as L (K') and R;  @param {number[]} t  3 numbers, as n;  @param {number} d */
function homographyOfPlane(K, L, R, t, n, d) {
  // Three rows of three numbers.
  return [];
}
`,
  solution: `function homographyOfPlane(K, L, R, t, n, d) {
  const times = (A, B) => A.map((row) => B[0].map((_, j) => row.reduce((sum, v, k) => sum + v * B[k][j], 0)));
  const [[f, s, u], [, g, v]] = K;
  const inverse = [[1 / f, -s / (f * g), (s * v - u * g) / (f * g)], [0, 1 / g, -v / g], [0, 0, 1]];
  const between = R.map((row, i) => row.map((value, j) => value + (t[i] * n[j]) / d));
  return times(L, times(between, inverse));
}
`,
  unit: "px",
  limit: 1e-3,
  plant: (random) => {
    const [first, second] = [plantedCamera(random), plantedCamera(random)];
    // From the first camera to the second: X′ = R′ Rᵀ (X − t) + t′.
    const r = times(second.r, transpose(first.r));
    const t = sub(second.t, apply(r, first.t));
    // A roof: steep as roofs are, its distance from the camera beyond doubt.
    const slope = between(random, 0.2, 0.7);
    const azimuth = between(random, 0, 2 * Math.PI);
    const up = [Math.sin(slope) * Math.cos(azimuth), Math.sin(slope) * Math.sin(azimuth), Math.cos(slope)];
    const n = apply(first.r, up);
    const d = dot(n, add(apply(first.r, [0, 0, between(random, 0, 8)]), first.t));
    const rays = Array.from({ length: POINTS }, () => [between(random, 0, 800), between(random, 0, 600)]);
    const pairs = rays.map((x) => {
      const ray = apply(inverse(first.k), [...x, 1]);
      const moved = add(apply(r, scaled(ray, d / dot(n, ray))), t);
      return [x, dehomogenised(apply(second.k, moved))] as const;
    });
    return {
      input: [first.k, second.k, r, t, n, d],
      error: (h) => Math.max(...pairs.map(([x, y]) => distance(y, dehomogenised(apply(h, [...x, 1]))))),
    };
  },
  formProblem: (answer) => matrixProblem(answer, 3, 3),
  isSame: isSameUpToScale,
  mistakes: {
    "R transposed": {
      says: "R turns the wrong way: Rᵀ stands where R should. Some files state the rotation from the camera to the world; here R takes from the first camera to the second.",
      variants: [(k, l, r, t, n, d) => homography(k, l, transpose(r), t, n, d)],
    },
    "wrong sign": {
      says: "The sign of t nᵀ / d is wrong. With n · X = d it is a plus; the minus belongs to planes that are written n · X + d = 0.",
      variants: [(k, l, r, t, n, d) => homography(k, l, r, t, n, d, -1)],
    },
    "not divided by the distance": {
      says: "t nᵀ is not divided by d. Only n · X / d is 1 on the plane; without it the plane lies 1 m away from the camera.",
      variants: [(k, l, r, t, n) => homography(k, l, r, t, n, 1)],
    },
    "multiplied by the distance": {
      says: "t nᵀ is multiplied by d. Divide by it: it is n · X / d that is 1 on the plane.",
      variants: [(k, l, r, t, n, d) => homography(k, l, r, t, n, 1 / d)],
    },
    "other direction": {
      says: "This is H⁻¹: it takes the second view to the first.",
      variants: [(...input) => inverse(homography(...input))],
    },
    "K not inverted": {
      says: "K stands on the right as it is. Pixels become directions by K⁻¹.",
      variants: [(k, l, r, t, n, d) => times(l, times(sum(r, outer(t, n), 1 / d), k))],
    },
    "K forgotten": {
      says: "This takes directions to directions: for pixels, K⁻¹ on the right and K′ on the left are missing.",
      variants: [(_, __, r, t, n, d) => sum(r, outer(t, n), 1 / d)],
    },
    "cameras exchanged": {
      says: "K and K′ have changed places: K⁻¹ stands on the right, where pixels of the first photograph come in, and K′ on the left.",
      variants: [(k, l, ...of) => homography(l, k, ...of)],
    },
    "n and t exchanged": {
      says: "n tᵀ stands in the place of t nᵀ: columns are moved along t, by n · X.",
      variants: [(k, l, r, t, n, d) => homography(k, l, r, n, t, d)],
    },
    "half a pixel": {
      says: "The result is shifted by half a pixel: the principal point is in the coordinates of the images already, with the centre of the first pixel at (0.5, 0.5).",
      variants: [0.5, -0.5].flatMap((by) => [
        (...input: Input) => times(shift(by), times(homography(...input), shift(-by))),
        (...input: Input) => times(homography(...input), shift(by)),
        (...input: Input) => times(shift(by), homography(...input)),
      ]),
    },
  },
});

/** Where a camera sees a point: x ≃ P X, on which everything rests (B99 3.1; W96 3.2). */
import { add, apply, type Mat, norm, scaled, sub, transpose } from "../../shared/linear";
import { functionExercise, vectorProblem } from "../judging/judge";
import { dehomogenised, distance, type Vector } from "../judging/linear";
import { plantedCamera, plantedPoint, seen } from "../judging/random";

type Input = readonly [k: Mat, r: Mat, c: Vector, x: Vector];

/** K R (X − C) */
function imageOf(k: Mat, r: Mat, ray: Vector): Vector {
  return dehomogenised(apply(k, apply(r, ray)));
}

export const project = functionExercise<Input, Vector>({
  name: "project",
  title: "The image of a point",
  lesson: "pinhole",
  source: "B99 3.1, W96 3.2",
  text: "Given the [[camera-matrix|calibration matrix]] K, the rotation R from the world to the camera and the [[projection-centre]] C, return the image [u, v] of a point X, in pixels. K and R are 3 × 3; C and X have three coordinates in metres. A point of the world is R (X − C) in the camera's frame, whose third axis looks forward.",
  starter: `/** @param {number[][]} K  3 rows of 3, as R;  @param {number[]} C  3 numbers, as X. */
function project(K, R, C, X) {
  // Two numbers.
  return [];
}
`,
  solution: `function project(K, R, C, X) {
  const times = (A, v) => A.map((row) => row.reduce((sum, a, i) => sum + a * v[i], 0));
  const [x, y, w] = times(K, times(R, X.map((value, i) => value - C[i])));
  return [x / w, y / w];
}
`,
  unit: "px",
  limit: 1e-3,
  plant: (random) => {
    const { k, r, t, projection } = plantedCamera(random);
    const centre = scaled(apply(transpose(r), t), -1);
    const point = plantedPoint(random);
    return {
      input: [k, r, centre, point],
      error: (answer) => distance(seen(projection, point), answer),
    };
  },
  formProblem: (answer) => vectorProblem(answer, 2, "image"),
  isSame: (a, b) => distance(a, b) < 1e-6 * (1 + norm(a)),
  mistakes: {
    "R transposed": {
      says: "Rᵀ stands where R should. R takes from the world to the camera; files that state the rotation from the camera to the world have its transpose.",
      variants: [(k, r, c, x) => imageOf(k, transpose(r), sub(x, c))],
    },
    "C for t": {
      says: "This is K (R X + C) or K (R X − C): the centre is in the world's frame and must be turned with the point. Either R (X − C), or R X + t with t = −R C.",
      variants: [1, -1].map(
        (sign) =>
          (...[k, r, c, x]: Input) =>
            dehomogenised(apply(k, add(apply(r, x), c, -sign))),
      ),
    },
    "wrong sign": {
      says: "C is added to X. The ray goes from the centre to the point: X − C.",
      variants: [(k, r, c, x) => imageOf(k, r, add(x, c))],
    },
    "not divided by the depth": {
      says: "These are the first two homogeneous coordinates. Divide by the third one, the depth.",
      variants: [(k, r, c, x) => apply(k, apply(r, sub(x, c))).slice(0, 2)],
    },
    "K forgotten": {
      says: "These are directions in the camera's frame, not pixels: K is missing.",
      variants: [(_, r, c, x) => dehomogenised(apply(r, sub(x, c)))],
    },
    "principal point forgotten": {
      says: "The result counts from the principal point. Pixels count from the corner of the image: add the third column of K.",
      variants: [(k, r, c, x) => sub(imageOf(k, r, sub(x, c)), [k[0]?.[2] ?? 0, k[1]?.[2] ?? 0])],
    },
    "half a pixel": {
      says: "The result is shifted by half a pixel: the principal point is in the coordinates of the image already. The centre of the first pixel is (0.5, 0.5), and nothing is to be added.",
      variants: [0.5, -0.5].map(
        (by) =>
          (...[k, r, c, x]: Input) =>
            imageOf(k, r, sub(x, c)).map((value) => value + by),
      ),
    },
    "x and y exchanged": {
      says: "u and v have changed places: u counts to the right, by the first row of K.",
      variants: [(k, r, c, x) => [...imageOf(k, r, sub(x, c))].reverse()],
    },
  },
});

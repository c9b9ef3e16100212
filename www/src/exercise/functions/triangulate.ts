/** A point in space from two views: what every 3D line of B99 3.2 rests on. */
import { type Mat, norm } from "../../shared/linear";
import { functionExercise, vectorProblem } from "../judging/judge";
import { distance, leastSquares, type Vector } from "../judging/linear";
import { plantedCamera, plantedPoint, seen } from "../judging/random";

type Input = readonly [p: Mat, x: Vector, q: Mat, y: Vector];

/** u p₃ − p₁ and v p₃ − p₂ of both views, solved for (X, Y, Z, 1). `sign` −1 makes sums of the differences. */
function triangulated(p: Mat, x: Vector, q: Mat, y: Vector, sign = 1): Vector {
  const rows = (
    [
      [p, x],
      [q, y],
    ] as const
  ).flatMap(([of, at]) =>
    [0, 1].map((row) => (of[2] ?? []).map((third, k) => (at[row] ?? 0) * third - sign * (of[row]?.[k] ?? 0))),
  );
  return leastSquares(
    rows.map((row) => row.slice(0, 3)),
    rows.map((row) => -(row[3] ?? 0)),
  );
}

const shifted = ([u = 0, v = 0]: Vector, by: number): number[] => [u + by, v + by];
const swapped = ([u = 0, v = 0]: Vector): number[] => [v, u];

export const triangulate = functionExercise<Input, Vector>({
  name: "triangulate",
  title: "A point from two views",
  lesson: "triangulation",
  source: "B99 3.2",
  text: "Given [[projection|projections]] P and P′ (3 × 4) and the images x = [u, v] and x′ of a point in pixels, return the point [X, Y, Z]. Each image gives two linear equations in the homogeneous point: u (p₃ · X) − p₁ · X = 0 and v (p₃ · X) − p₂ · X = 0, where p₁, p₂, p₃ are the rows of P. Coordinates are those of the projections: nothing is to be shifted.",
  starter: `/** @param {number[][]} P  3 rows of 4;  @param {number[]} x  [u, v];  Q and y are P' and x'. */
function triangulate(P, x, Q, y) {
  // Three numbers.
  return [];
}
`,
  solution: `function triangulate(P, x, Q, y) {
  const rows = [[P, x], [Q, y]].flatMap(([M, at]) => [0, 1].map((k) => M[2].map((v, j) => at[k] * v - M[k][j])));
  const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
  // Normal equations of the three unknowns; the fourth coordinate is 1.
  const column = (j) => rows.map((row) => row[j]);
  const A = [0, 1, 2].map((i) => [0, 1, 2].map((j) => dot(column(i), column(j))));
  const b = [0, 1, 2].map((i) => -dot(column(i), column(3)));
  const det = ([[a, c, d], [e, f, g], [h, k, l]]) => a * (f * l - g * k) - c * (e * l - g * h) + d * (e * k - f * h);
  return [0, 1, 2].map((j) => det(A.map((row, i) => row.map((v, k) => (k === j ? b[i] : v)))) / det(A));
}
`,
  unit: "m",
  limit: 1e-3,
  plant: (random) => {
    const [first, second] = [plantedCamera(random), plantedCamera(random)];
    const point = plantedPoint(random);
    return {
      input: [
        first.projection,
        seen(first.projection, point),
        second.projection,
        seen(second.projection, point),
      ],
      error: (answer) => distance(point, answer),
    };
  },
  formProblem: (answer) => vectorProblem(answer, 3, "point"),
  isSame: (a, b) => distance(a, b) < 1e-5 * (1 + norm(a)),
  mistakes: {
    "half a pixel": {
      says: "The point is where it would be if the images were shifted by half a pixel. The centre of the first pixel is (0.5, 0.5), in images and projections alike: nothing is to be added.",
      variants: [0.5, -0.5].map(
        (by) =>
          (...[p, x, q, y]: Input) =>
            triangulated(p, shifted(x, by), q, shifted(y, by)),
      ),
    },
    "x and y exchanged": {
      says: "u belongs to the first row of P and v to the second; they have changed places.",
      variants: [(p, x, q, y) => triangulated(p, swapped(x), q, swapped(y))],
    },
    "wrong sign": {
      says: "The equations are differences, u p₃ − p₁, not sums: the sign of p₁ and p₂ is wrong.",
      variants: [(p, x, q, y) => triangulated(p, x, q, y, -1)],
    },
    "views exchanged": {
      says: "Each image point goes with the projection of its own view: here x is used with P′, and x′ with P.",
      variants: [(p, x, q, y) => triangulated(p, y, q, x)],
    },
    "sign of the right side": {
      says: "The point is mirrored at the origin: with the fourth coordinate 1, the fourth column goes to the other side of the equations and changes its sign.",
      variants: [(...input) => triangulated(...input).map((value) => -value)],
    },
  },
});

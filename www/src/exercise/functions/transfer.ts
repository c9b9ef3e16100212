/** A point of two views in a third: what the trifocal tensor does for lines in B99 3.2. */
import { add, apply, cross, type Mat, norm, transpose } from "../../shared/linear";
import { functionExercise, vectorProblem } from "../judging/judge";
import { dehomogenised, distance, fundamental, type Vector } from "../judging/linear";
import { plantedCamera, plantedPoint, seen } from "../judging/random";

type Input = readonly [f: Mat, g: Mat, x: Vector, y: Vector];

const homogeneous = (x: Vector) => [...x, 1];

/** Where two lines meet. */
function meet(a: Vector, b: Vector): number[] {
  return dehomogenised(cross(a, b));
}

/** Where the epipolar lines of both points meet in the third view. */
function transferred(f: Mat, g: Mat, x: Vector, y: Vector): number[] {
  return meet(apply(f, homogeneous(x)), apply(g, homogeneous(y)));
}

export const transferPoint = functionExercise<Input, Vector>({
  name: "transferPoint",
  title: "A point in the third view",
  lesson: "trifocal",
  source: "B99 3.2",
  text: "Points x and x′ of two views show the same point in space. F takes x to its [[epipolar-line]] in a third view, G takes x′ to its epipolar line there. Return [u, v], where the third view must show the point: this is how a pair is [[verification|verified]]. (Two lines a and b meet in the homogeneous point a × b.)",
  starter: `/** @param {number[][]} F  3 rows of 3, as G;  @param {number[]} x  [u, v], as y (x'). */
function transferPoint(F, G, x, y) {
  // Two numbers.
  return [];
}
`,
  solution: `function transferPoint(F, G, x, y) {
  const line = (M, p) => M.map(([a, b, c]) => a * p[0] + b * p[1] + c);
  const [a, b] = [line(F, x), line(G, y)];
  const cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  return [cross[0] / cross[2], cross[1] / cross[2]];
}
`,
  unit: "px",
  limit: 1e-2,
  plant: (random) => {
    const point = plantedPoint(random);
    const [first, second, third] = [plantedCamera(random), plantedCamera(random), plantedCamera(random)].map(
      ({ projection }) => projection,
    ) as unknown as readonly [Mat, Mat, Mat];
    return {
      input: [fundamental(first, third), fundamental(second, third), seen(first, point), seen(second, point)],
      error: (answer) => distance(seen(third, point), answer),
    };
  },
  formProblem: (answer) => vectorProblem(answer, 2, "point"),
  isSame: (a, b) => distance(a, b) < 1e-5 * (1 + norm(a)),
  mistakes: {
    transposed: {
      says: "Fᵀ and Gᵀ stand where F and G should: the transpose takes a point of the third view to a line of another one.",
      variants: [(f, g, x, y) => transferred(transpose(f), transpose(g), x, y)],
    },
    "views exchanged": {
      says: "Each point goes with the matrix of its own view: here F is applied to x′, or G to x.",
      variants: [(f, g, x, y) => transferred(f, g, y, x)],
    },
    "not divided by the third": {
      says: "The cross product is homogeneous: its first two numbers are pixels only after a division by the third.",
      variants: [(f, g, x, y) => cross(apply(f, homogeneous(x)), apply(g, homogeneous(y))).slice(0, 2)],
    },
    "1 forgotten": {
      says: "The points are not homogeneous: the third coordinate, 1, is missing, and with it the last column of F and G.",
      variants: [(f, g, x, y) => meet(apply(f, [...x, 0]), apply(g, [...y, 0]))],
    },
    "lines added": {
      says: "The two epipolar lines are added. A sum of lines is a third line through their common point; the point itself is the cross product.",
      variants: [
        (f, g, x, y) => {
          const [a, b] = [apply(f, homogeneous(x)), apply(g, homogeneous(y))];
          return dehomogenised(add(a, b));
        },
      ],
    },
    "half a pixel": {
      says: "The points are shifted by half a pixel before, or the result after it. F and G are those of the images' own coordinates.",
      variants: [0.5, -0.5].flatMap((by) => [
        (...[f, g, x, y]: Input) =>
          transferred(
            f,
            g,
            x.map((value) => value + by),
            y.map((value) => value + by),
          ),
        (...input: Input) => transferred(...input).map((value) => value + by),
      ]),
    },
  },
});

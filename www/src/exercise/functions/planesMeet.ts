/** New lines where two planes meet: B99 4.2. */
import { add, apply, cross, dot, inverse, norm, scaled, sub, unit } from "../../shared/linear";
import { described, functionExercise, isVector } from "../judging/judge";
import type { Vector } from "../judging/linear";
import { between, plantedPoint, type Random } from "../judging/random";

type Input = readonly [n: Vector, d: number, m: Vector, e: number];
interface Line {
  point: Vector;
  direction: Vector;
}

/** The point of the line that is next to the origin, and its direction. */
function meet(n: Vector, d: number, m: Vector, e: number): Line {
  const direction = cross(n, m);
  return { point: apply(inverse([n, m, direction]), [d, e, 0]), direction };
}

/** Of a roof: its normal points up. */
function roof(random: Random, azimuth: number): number[] {
  const slope = between(random, 0.35, 0.8);
  return [Math.sin(slope) * Math.cos(azimuth), Math.sin(slope) * Math.sin(azimuth), Math.cos(slope)];
}

/** Of a point from a line. */
function distance(point: Vector, line: Line): number {
  return norm(cross(sub(point, line.point), unit(line.direction)));
}

export const lineFromPlanes = functionExercise<Input, Line>({
  name: "lineFromPlanes",
  title: "The line where two planes meet",
  lesson: "lines-in-space",
  source: "B99 4.2, figures 19 and 20",
  text: "Two roof planes n · X = d and m · X = e, with unit normals, meet in a [[ridge]]. Return it as { point, direction }: any point on it, and its direction of any length and sign, three numbers each. This is how [[intersection-line|new lines]] are made that no photograph shows clearly.",
  starter: `/** @param {number[]} n  3 numbers, as m;  @param {number} d  metres, as e. */
function lineFromPlanes(n, d, m, e) {
  return { point: [], direction: [] };
}
`,
  solution: `function lineFromPlanes(n, d, m, e) {
  const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
  const direction = [n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]];
  // The point is a n + b m: two equations, with the cosine between the normals.
  const c = dot(n, m);
  const a = (d - c * e) / (1 - c * c);
  const b = (e - c * d) / (1 - c * c);
  return { point: n.map((v, i) => a * v + b * m[i]), direction };
}
`,
  unit: "m",
  limit: 1e-3,
  plant: (random) => {
    const azimuth = between(random, 0, 2 * Math.PI);
    const [n, m] = [roof(random, azimuth), roof(random, azimuth + between(random, 1.4, 2.6))];
    const on = plantedPoint(random).map((value) => value + 20);
    const along = unit(cross(n, m));
    const truth = { point: on, direction: along };
    return {
      input: [n, dot(n, on), m, dot(m, on)],
      // Where the line is 10 m from its point, and at the point itself.
      error: ({ point, direction }) => {
        const far = add(point, unit(direction), 10);
        return Math.max(distance(point, truth), distance(far, truth));
      },
    };
  },
  formProblem: (answer) => {
    const { point, direction } = (answer ?? {}) as Partial<Line>;
    return isVector(point, 3) && isVector(direction, 3)
      ? null
      : `Return { point, direction } with three numbers each; this is ${described(answer)}.`;
  },
  isSame: (a, b) => {
    const [u, v] = [unit(a.direction), unit(b.direction)];
    return norm(cross(u, v)) < 1e-6 && distance(b.point, a) < 1e-5 * (1 + norm(a.point));
  },
  mistakes: {
    "wrong sign": {
      says: "The line is mirrored at the origin: the planes are read as n · X + d = 0. Here d is n · X.",
      variants: [(n, d, m, e) => meet(n, -d, m, -e)],
    },
    "sum for cross product": {
      says: "The direction is a sum or difference of the normals, which lies in neither plane. What is perpendicular to both normals is their cross product.",
      variants: [
        (n, d, m, e) => ({ ...meet(n, d, m, e), direction: add(n, m) }),
        (n, d, m, e) => ({ ...meet(n, d, m, e), direction: sub(n, m) }),
      ],
    },
    "point of one plane": {
      says: "The point lies in one of the planes only: d n is the foot of the origin in the first plane, e m in the second. It must fulfil both equations.",
      variants: [
        (n, d, m) => ({ point: scaled(n, d), direction: cross(n, m) }),
        (n, _, m, e) => ({ point: scaled(m, e), direction: cross(n, m) }),
      ],
    },
    "feet added": {
      says: "d n + e m lies in neither plane: the normals are not perpendicular to each other, so that each step leaves the other plane.",
      variants: [(n, d, m, e) => ({ point: add(scaled(n, d), m, e), direction: cross(n, m) })],
    },
    "point and direction exchanged": {
      says: "The point stands in the place of the direction, and the direction in that of the point.",
      variants: [
        (...input) => {
          const { point, direction } = meet(...input);
          return { point: direction, direction: point };
        },
      ],
    },
    "distances exchanged": {
      says: "d goes with n and e with m; they have changed places.",
      variants: [(n, d, m, e) => meet(n, e, m, d)],
    },
  },
});

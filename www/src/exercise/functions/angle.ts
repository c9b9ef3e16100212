/** The angle of a half-plane about its line: theta of B99 4.1. */
import { add, cross, DEGREE, dot, scaled, thetaFrame, unit } from "../../shared/linear";
import { functionExercise, numberProblem } from "../judging/judge";
import type { Vector } from "../judging/linear";
import { between, plantedPoint } from "../judging/random";

type Input = readonly [p: Vector, q: Vector, n: Vector];

/** The angle, radians, of the plane that rises to the left of p to q. */
function angle(p: Vector, q: Vector, n: Vector): number {
  const { along, left, up } = thetaFrame(p, q);
  const level = cross(n, along);
  const away = dot(level, left) < 0 ? scaled(level, -1) : level;
  return Math.atan2(dot(away, up), dot(away, left));
}

/** The steepest slope of a plane, radians. */
const slope = (n: Vector) => Math.acos(Math.min(1, Math.abs(n[2] ?? 0)));

export const angleOfPlane = functionExercise<Input, number>({
  name: "angleOfPlane",
  title: "The angle of a half-plane",
  lesson: "roofs",
  source: "B99 4.1, figure 10",
  text: "A plane with the unit normal n contains the 3D line from p to q. Return the angle θ, in degrees, of the [[half-plane]] to the left of the line, seen from above: the angle, about the line, between the horizontal direction across it and the plane. θ is positive where the plane rises away from the line, and lies between −90° and 90°. The line may rise itself; n points up.",
  starter: `/** @param {number[]} p  3 numbers, as q and n. */
function angleOfPlane(p, q, n) {
  // Degrees.
  return 0;
}
`,
  solution: `function angleOfPlane(p, q, n) {
  const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => a.map((v) => v / Math.hypot(...a));
  const along = unit(q.map((v, i) => v - p[i]));
  const outward = unit(cross([0, 0, 1], along));
  const up = cross(along, outward);
  const away = cross(n, along);
  const sign = dot(away, outward) < 0 ? -1 : 1;
  return (Math.atan2(sign * dot(away, up), sign * dot(away, outward)) * 180) / Math.PI;
}
`,
  unit: "deg",
  limit: 1e-4,
  plant: (random) => {
    const p = plantedPoint(random);
    const azimuth = between(random, 0, 2 * Math.PI);
    const rise = between(random, 0.12, 0.5) * (random() < 0.5 ? -1 : 1);
    const along = [Math.cos(azimuth) * Math.cos(rise), Math.sin(azimuth) * Math.cos(rise), Math.sin(rise)];
    const q = add(p, along, 8);
    const planted = between(random, 0.15, 1) * (random() < 0.5 ? -1 : 1);
    const { left, up } = thetaFrame(p, q);
    const away = add(scaled(left, Math.cos(planted)), up, Math.sin(planted));
    const normal = unit(cross(along, away));
    const n = normal[2] < 0 ? scaled(normal, -1) : normal;
    return { input: [p, q, n], error: (answer) => Math.abs(answer - planted / DEGREE) };
  },
  formProblem: (answer) => numberProblem(answer, "degrees"),
  isSame: (a, b) => Math.abs(a - b) < 1e-5,
  mistakes: {
    "radians for degrees": {
      says: "The result is in radians. Multiply by 180 / π.",
      variants: [(...input) => angle(...input)],
    },
    "wrong side": {
      says: "This is the angle of the half-plane to the right of the line, or its sign is wrong: what rises to the left falls to the right.",
      variants: [(...input) => -angle(...input) / DEGREE],
    },
    "sign lost": {
      says: "The result has no sign: whether the roof rises or falls away from the line is lost. Use atan2 with both components.",
      variants: [(...input) => Math.abs(angle(...input)) / DEGREE],
    },
    "slope of the plane": {
      says: "This is the steepest slope of the plane, the angle between n and the vertical. θ is measured about the line, across it.",
      variants: [(_, __, n) => slope(n) / DEGREE],
    },
    "from the vertical": {
      says: "The angle is measured from the vertical. θ is 0 where the half-plane is level across the line.",
      variants: [
        (...input) => 90 - angle(...input) / DEGREE,
        (...input) => 90 - Math.abs(angle(...input)) / DEGREE,
      ],
    },
  },
});

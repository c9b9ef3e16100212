/** Do two stretches of a line have a part in common? The weak constraint of the epipolar beam, B99 3.1. */
import { functionExercise, numberProblem } from "../judging/judge";
import { between } from "../judging/random";

type Interval = readonly [number, number];
type Input = readonly [a: Interval, b: Interval];

const ordered = ([from, to]: Interval): Interval => [Math.min(from, to), Math.max(from, to)];
const lengthOf = ([from, to]: Interval) => Math.abs(to - from);

/** Negative: the gap between them. */
function overlap(a: Interval, b: Interval): number {
  const [p, q] = [ordered(a), ordered(b)];
  return Math.min(p[1], q[1]) - Math.max(p[0], q[0]);
}

export const signedOverlap = functionExercise<Input, number>({
  name: "signedOverlap",
  title: "Overlap within an epipolar beam",
  lesson: "epipolar",
  source: "B99 3.1, figure 2",
  text: "The ends of a segment give two [[epipolar-line|epipolar lines]], between which its match must lie: the [[epipolar-beam]]. They cut the line of a candidate at a = [a₀, a₁]; the candidate itself reaches over b = [b₀, b₁], in pixels along the same line. Return how long their common part is, and where there is none, minus the gap between them. Either may be given backwards.",
  starter: `/** @param {number[]} a  2 numbers, as b; in any order. */
function signedOverlap(a, b) {
  // Pixels.
  return 0;
}
`,
  solution: `function signedOverlap(a, b) {
  return Math.min(Math.max(...a), Math.max(...b)) - Math.max(Math.min(...a), Math.min(...b));
}
`,
  unit: "px",
  limit: 1e-6,
  plant: (random) => {
    const centre = between(random, -200, 200);
    const [half, other] = [between(random, 10, 60), between(random, 10, 60)];
    // Apart, across each other, or one inside the other.
    const away = between(random, 0, 1.6) * (half + other) * (random() < 0.5 ? -1 : 1);
    const turn = (of: Interval): Interval => (random() < 0.5 ? of : [of[1], of[0]]);
    const a = turn([centre - half, centre + half]);
    const b = turn([centre + away - other, centre + away + other]);
    const common = Math.min(2 * half, 2 * other, half + other - Math.abs(away));
    return { input: [a, b], error: (answer) => Math.abs(answer - common) };
  },
  formProblem: (answer) => numberProblem(answer, "pixels"),
  isSame: (a, b) => Math.abs(a - b) < 1e-6,
  mistakes: {
    "gap lost": {
      says: "Where the stretches do not meet, the result is 0. How far apart they are must be said as well: ends are unreliable, and a small gap is no contradiction.",
      variants: [(a, b) => Math.max(0, overlap(a, b))],
    },
    "order taken for granted": {
      says: "A stretch may be given backwards: in the other view the segment may run the other way. Order the two ends first.",
      variants: [(a, b) => Math.min(a[1], b[1]) - Math.max(a[0], b[0])],
    },
    "union for intersection": {
      says: "This is the length from the first end to the last one, of both together. The common part begins at the later beginning and ends at the earlier end.",
      variants: [(a, b) => Math.max(...a, ...b) - Math.min(...a, ...b)],
    },
    "wrong sign": {
      says: "The sign is wrong: a common part is positive, a gap negative.",
      variants: [(a, b) => -overlap(a, b)],
    },
    "sign lost": {
      says: "The result has no sign: a gap of 10 px looks like 10 px in common.",
      variants: [(a, b) => Math.abs(overlap(a, b))],
    },
    "share for length": {
      says: "The result is divided by a length. Pixels are asked for.",
      variants: [
        (a, b) => overlap(a, b) / lengthOf(a),
        (a, b) => overlap(a, b) / lengthOf(b),
        (a, b) => overlap(a, b) / Math.min(lengthOf(a), lengthOf(b)),
      ],
    },
  },
});

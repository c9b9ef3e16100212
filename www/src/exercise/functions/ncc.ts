/** Normalised cross-correlation, by which B99 3.1 compares windows. */
import { dot } from "../../shared/linear";
import { described, functionExercise } from "../judging/judge";
import type { Vector } from "../judging/linear";
import { between, normal, type Random } from "../judging/random";

type Input = readonly [a: Vector, b: Vector];

const PIXELS = 49;

const mean = (a: Vector) => a.reduce((sum, value) => sum + value, 0) / a.length;
const less = (a: Vector, by: number) => a.map((value) => value - by);
const centred = (a: Vector) => less(a, mean(a));

/** The quotient; 0 where a window is constant. */
function correlation(a: Vector, b: Vector): number {
  const [u, v] = [centred(a), centred(b)];
  const size = Math.sqrt(dot(u, u) * dot(v, v));
  return size > 1e-9 ? dot(u, v) / size : 0;
}

/** A vector of unit length and mean 0, orthogonal to others. */
function direction(random: Random, others: readonly Vector[]): number[] {
  const start = centred(Array.from({ length: PIXELS }, () => normal(random)));
  const left = others.reduce<number[]>((rest, one) => {
    const share = dot(rest, one);
    return rest.map((value, i) => value - share * (one[i] ?? 0));
  }, start);
  const size = Math.hypot(...left);
  return left.map((value) => value / size);
}

export const ncc = functionExercise<Input, number>({
  name: "ncc",
  title: "Normalised cross-correlation",
  lesson: "correlation",
  source: "B99 3.1",
  text: "Given the grey values of two windows as arrays of equal length, return their normalised [[correlation|cross-correlation]], from −1 to 1. It does not change when a window gets brighter or has more contrast. Where a window is constant, there is nothing to correlate: return 0.",
  starter: `/** @param {number[]} a  grey values;  @param {number[]} b  as many. */
function ncc(a, b) {
  // A number.
  return 0;
}
`,
  solution: `function ncc(a, b) {
  const centred = (w) => w.map((v) => v - w.reduce((sum, one) => sum + one, 0) / w.length);
  const dot = (p, q) => p.reduce((sum, v, i) => sum + v * q[i], 0);
  const [u, v] = [centred(a), centred(b)];
  const size = Math.sqrt(dot(u, u) * dot(v, v));
  return size > 1e-9 ? dot(u, v) / size : 0;
}
`,
  unit: "",
  limit: 1e-6,
  plant: (random) => {
    const u = direction(random, []);
    const v = direction(random, [u]);
    const r = between(random, 0.2, 0.95) * (random() < 0.3 ? -1 : 1);
    // One window in six has one grey value only.
    const isConstant = random() < 1 / 6;
    const [brightA, brightB] = [between(random, 60, 200), between(random, 60, 200)];
    const [contrastA, contrastB] = [between(random, 20, 90), between(random, 20, 90)];
    const other = u.map((value, i) => r * value + Math.sqrt(1 - r * r) * (v[i] ?? 0));
    const planted = isConstant ? 0 : r;
    return {
      input: [
        u.map((value) => (isConstant ? brightA : brightA + contrastA * value)),
        other.map((value) => brightB + contrastB * value),
      ],
      error: (answer) => Math.abs(answer - planted),
    };
  },
  // NaN is a number that can be judged: dividing by nothing is a usual mistake.
  formProblem: (answer) =>
    typeof answer === "number" ? null : `Return one number; this is ${described(answer)}.`,
  isSame: (a, b) => Object.is(a, b) || Math.abs(a - b) < 1e-6 * (1 + Math.abs(a)),
  mistakes: {
    "mean not subtracted": {
      says: "The means are still in the windows: two bright windows look alike whatever they show. Subtract each window's own mean first.",
      variants: [
        (a, b) => dot(a, b) / Math.sqrt(dot(a, a) * dot(b, b)),
        (a, b) => {
          const [u, v] = [centred(a), centred(b)];
          const size = Math.sqrt(dot(a, a) * dot(b, b));
          return dot(u, v) / size;
        },
      ],
    },
    "not normalised": {
      says: "This is the covariance: it grows with the contrast of the windows. Divide by the product of both standard deviations.",
      variants: [
        (a, b) => dot(centred(a), centred(b)),
        (a, b) => dot(centred(a), centred(b)) / a.length,
        (a, b) => dot(centred(a), centred(b)) / (a.length - 1),
      ],
    },
    "variance for standard deviation": {
      says: "The product of the variances stands in the denominator; it is its square root that makes the result a number from −1 to 1.",
      variants: [
        quotient((u, v) => dot(u, u) * dot(v, v)),
        quotient((u, v) => (dot(u, u) * dot(v, v)) / PIXELS),
      ],
    },
    "n and n − 1 mixed": {
      says: "The covariance is divided by n and the variances by n − 1, or the other way round. Take one of them throughout, or neither: it cancels.",
      variants: [
        (a, b) => (correlation(a, b) * (a.length - 1)) / a.length,
        (a, b) => (correlation(a, b) * a.length) / (a.length - 1),
      ],
    },
    "sign lost": {
      says: "The result has no sign: a negative is not like its positive. Do not square or take the absolute value.",
      variants: [(a, b) => Math.abs(correlation(a, b)), (a, b) => correlation(a, b) ** 2],
    },
    "one mean for both": {
      says: "The mean of one window, or of both together, is subtracted from both. Each has its own.",
      variants: [
        (a, b) => withMeans(a, b, mean(a), mean(a)),
        (a, b) => withMeans(a, b, mean(b), mean(b)),
        (a, b) => withMeans(a, b, (mean(a) + mean(b)) / 2, (mean(a) + mean(b)) / 2),
      ],
    },
    "divided by nothing": {
      says: "Right, but for a constant window, where the result is NaN: its standard deviation is 0. Ask before you divide.",
      variants: [
        (a, b) => {
          const [u, v] = [centred(a), centred(b)];
          return dot(u, u) > 1e-9 ? correlation(a, b) : dot(u, v) / Math.sqrt(dot(u, u) * dot(v, v));
        },
      ],
    },
  },
});

function quotient(below: (u: Vector, v: Vector) => number): (a: Vector, b: Vector) => number {
  return (a, b) => {
    const [u, v] = [centred(a), centred(b)];
    const size = below(u, v);
    return size > 1e-9 ? dot(u, v) / size : 0;
  };
}

function withMeans(a: Vector, b: Vector, meanA: number, meanB: number): number {
  const [u, v] = [less(a, meanA), less(b, meanB)];
  return dot(u, v) / Math.sqrt(dot(u, u) * dot(v, v));
}

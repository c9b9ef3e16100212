/** The description length of a region: what W96 3.3 minimises. */
import { functionExercise, numberProblem } from "../judging/judge";
import type { Vector } from "../judging/linear";
import { between, normal } from "../judging/random";

type Input = readonly [values: Vector];

const E2PI = 2 * Math.PI * Math.E;

/** Mean of the squares about the mean, or about `from`. */
function variance(values: Vector, below = values.length): number {
  const mean = values.reduce((all, value) => all + value, 0) / values.length;
  return values.reduce((all, value) => all + (value - mean) ** 2, 0) / below;
}

function length(n: number, squares: number, parameters = Math.log2(n)): number {
  return (n / 2) * Math.log2(E2PI * squares) + parameters;
}

export const descriptionLength = functionExercise<Input, number>({
  name: "descriptionLength",
  title: "The description length of a region",
  lesson: "object-space",
  source: "W96 3.3",
  text: "ORIS describes a [[region]] by its mean grey level and noise. Return the [[description-length]] of n grey values, in bits: n/2 · log₂(2π e s²) for the values, given mean and variance, plus log₂ n for these two parameters, half a log₂ n each. s² is the mean of the squared deviations from the mean of the region itself.",
  starter: `/** @param {number[]} values  grey values of a region. */
function descriptionLength(values) {
  // Bits.
  return 0;
}
`,
  solution: `function descriptionLength(values) {
  const n = values.length;
  const mean = values.reduce((sum, v) => sum + v, 0) / n;
  const s2 = values.reduce((sum, v) => sum + (v - mean) ** 2, 0) / n;
  return (n / 2) * Math.log2(2 * Math.PI * Math.E * s2) + Math.log2(n);
}
`,
  unit: "bits",
  limit: 1e-6,
  plant: (random) => {
    const count = Math.round(between(random, 20, 200));
    const [level, sigma] = [between(random, 60, 200), between(random, 2, 12)];
    // Noise whose mean and variance are exactly those that are planted.
    const raw = Array.from({ length: count }, () => normal(random));
    const mean = raw.reduce((all, value) => all + value, 0) / count;
    const size = Math.sqrt(variance(raw));
    const values = raw.map((value) => level + (sigma * (value - mean)) / size);
    const planted = length(count, sigma ** 2);
    return { input: [values], error: (answer) => Math.abs(answer - planted) };
  },
  formProblem: (answer) => numberProblem(answer, "bits"),
  isSame: (a, b) => Math.abs(a - b) < 1e-7 * (1 + Math.abs(a)),
  mistakes: {
    "nats for bits": {
      says: "The logarithms are natural: the result is in nats. Bits take the logarithm to the base 2.",
      variants: [(values) => length(values.length, variance(values)) * Math.LN2],
    },
    "log10 for log2": {
      says: "The logarithms are those to the base 10. Bits take the logarithm to the base 2.",
      variants: [(values) => length(values.length, variance(values)) * Math.log10(2)],
    },
    "parameters forgotten": {
      says: "Mean and variance cost nothing here. Without their log₂ n, cutting a region in two always pays.",
      variants: [(values) => length(values.length, variance(values), 0)],
    },
    "half the parameters": {
      says: "Two parameters cost half a log₂ n each, which is log₂ n together.",
      variants: [
        (values) => length(values.length, variance(values), Math.log2(values.length) / 2),
        (values) => length(values.length, variance(values), Math.log2(values.length) * 2),
      ],
    },
    "standard deviation for variance": {
      says: "s stands where s² should, or the half before n is missing: half of log₂ s² is log₂ s.",
      variants: [
        (values) => length(values.length, Math.sqrt(variance(values))),
        (values) => 2 * length(values.length, variance(values), 0) + Math.log2(values.length),
      ],
    },
    "n − 1 for n": {
      says: "The squares are divided by n − 1. The shortest code is that of the mean of the squares, divided by n.",
      variants: [(values) => length(values.length, variance(values, values.length - 1))],
    },
    "mean not subtracted": {
      says: "The squares are those of the grey values themselves. s² is about the mean of the region: the noise, not the brightness.",
      variants: [
        (values) => length(values.length, values.reduce((all, value) => all + value ** 2, 0) / values.length),
      ],
    },
  },
});

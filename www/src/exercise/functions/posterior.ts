/** From evidence to a probability: the statistical foundation that B99 5 asks for. */
import { functionExercise, numberProblem } from "../judging/judge";
import type { Vector } from "../judging/linear";
import { between } from "../judging/random";

type Input = readonly [prior: number, nats: Vector];

const total = (nats: Vector) => nats.reduce((all, value) => all + value, 0);
const logOdds = (p: number) => Math.log(p / (1 - p));
const probability = (odds: number) => odds / (1 + odds);

export const posterior = functionExercise<Input, number>({
  name: "posterior",
  title: "From evidence to a probability",
  lesson: "evidence",
  source: "B99 5",
  text: "A candidate is true with the probability prior, before anything is measured. Each independent feature then says something about it: the natural logarithm of the [[likelihood-ratio]], in [[nat|nats]], positive where it is likelier on true candidates. Return the [[posterior]] probability that the candidate is true, from 0 to 1. Logarithms of [[odds]] add: ln odds = ln (prior / (1 − prior)) + Σ nats.",
  starter: `/** @param {number} prior  0 to 1;  @param {number[]} nats */
function posterior(prior, nats) {
  // A probability.
  return 0;
}
`,
  solution: `function posterior(prior, nats) {
  const logOdds = Math.log(prior / (1 - prior)) + nats.reduce((sum, v) => sum + v, 0);
  return 1 / (1 + Math.exp(-logOdds));
}
`,
  unit: "",
  limit: 1e-6,
  plant: (random) => {
    const planted = between(random, 0.05, 0.95);
    const prior = between(random, 0.05, 0.45);
    const count = Math.round(between(random, 2, 5));
    const parts = Array.from({ length: count - 1 }, () => between(random, -2, 2));
    // The last feature makes up for what is planted.
    const rest = logOdds(planted) - logOdds(prior) - total(parts);
    return { input: [prior, [...parts, rest]], error: (answer) => Math.abs(answer - planted) };
  },
  formProblem: (answer) => numberProblem(answer, "from 0 to 1"),
  isSame: (a, b) => Math.abs(a - b) < 1e-7 * (1 + Math.abs(a)),
  mistakes: {
    "prior forgotten": {
      says: "This begins with even odds. A candidate that is seldom true needs more evidence: add ln (prior / (1 − prior)).",
      variants: [(_, nats) => probability(Math.exp(total(nats)))],
    },
    "probability for odds": {
      says: "ln prior stands where ln (prior / (1 − prior)) should: it is logarithms of odds that add, not of probabilities.",
      variants: [
        (prior, nats) => probability(Math.exp(Math.log(prior) + total(nats))),
        (prior, nats) => prior * Math.exp(total(nats)),
        (prior, nats) => Math.min(1, prior * Math.exp(total(nats))),
      ],
    },
    "odds for a probability": {
      says: "These are the odds, which may be larger than 1. Divide them by 1 + odds.",
      variants: [(prior, nats) => Math.exp(logOdds(prior) + total(nats))],
    },
    "logarithm of the odds": {
      says: "This is the sum of the logarithms, which may be negative. The exponential makes odds of it, and odds / (1 + odds) the probability.",
      variants: [(prior, nats) => logOdds(prior) + total(nats)],
    },
    "log10 for ln": {
      says: "Logarithms to the base 10 are mixed with natural ones: nats are natural logarithms.",
      variants: [
        (prior, nats) => probability(10 ** (Math.log10(prior / (1 - prior)) + total(nats))),
        (prior, nats) => probability(Math.exp(Math.log10(prior / (1 - prior)) + total(nats))),
      ],
    },
    "bits for nats": {
      says: "The powers are those of 2: the evidence is read as bits. One nat is 1.44 bits.",
      variants: [(prior, nats) => probability((prior / (1 - prior)) * 2 ** total(nats))],
    },
    "mean for sum": {
      says: "The features are averaged. Each independent one adds what it says.",
      variants: [(prior, nats) => probability(Math.exp(logOdds(prior) + total(nats) / nats.length))],
    },
    "wrong sign": {
      says: "This is the probability that the candidate is false: a sign is wrong.",
      variants: [(prior, nats) => 1 - probability(Math.exp(logOdds(prior) + total(nats)))],
    },
  },
});

/** Evidence in nats: logarithms of likelihood ratios, which add where observations are independent. */
import type { Vec2 } from "../../shared/records";

interface Beta {
  a: number;
  b: number;
}

/** Correlations on a true plane and beside it, as beta distributions over (1 + c) / 2. */
export const ON_PLANE: Beta = { a: 9, b: 1.8 };
export const OFF_PLANE: Beta = { a: 5, b: 5 };

/** log Gamma, by Lanczos' series: exact to 1e-10 for what is asked here. */
export function logGamma(x: number): number {
  const terms = [
    676.5203681218851, -1259.1392167224028, 771.3234287776531, -176.6150291621406, 12.507343278686905,
    -0.13857109526572012, 9.984369578019572e-6, 1.5056327351493116e-7,
  ];
  const t = x + 6.5;
  const sum = terms.reduce((all, one, i) => all + one / (x + i), 0.9999999999998099);
  return 0.5 * Math.log(2 * Math.PI) + (x - 0.5) * Math.log(t) - t + Math.log(sum);
}

/** Density of a correlation c, -1 to 1. */
export function density({ a, b }: Beta, c: number): number {
  const u = Math.min(1 - 1e-6, Math.max(1e-6, (1 + c) / 2));
  const log = logGamma(a + b) - logGamma(a) - logGamma(b) + (a - 1) * Math.log(u) + (b - 1) * Math.log(1 - u);
  return Math.exp(log) / 2;
}

/**
 * What a correlation says for the plane, nats.
 * @param hidden probability that the view does not see the plane at all
 */
export function natsOf(c: number, hidden = 0): number {
  const off = density(OFF_PLANE, c);
  return Math.log(((1 - hidden) * density(ON_PLANE, c) + hidden * off) / off);
}

/** The probability that follows from nats and the odds before. */
export const probabilityOf = (nats: number, prior = 0.5): number =>
  1 / (1 + ((1 - prior) / prior) * Math.exp(-nats));

/** The nats of a step of an edge: Gaussian noise, a contrast of `mean` standard deviations expected there. */
export const edgeNats = (z: number, mean: number): number => mean * z - mean ** 2 / 2;

/** A repeatable stream of numbers from 0 to 1. */
export function stream(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296;
  };
}

/** A value of the standard normal distribution. */
export function normal(random: () => number): number {
  return Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
}

/** A place with so much noise in both directions. */
export const noisy = ([x, y]: Vec2, sigma: number, random: () => number): Vec2 => [
  x + sigma * normal(random),
  y + sigma * normal(random),
];

/**
 * What was stated and what was true, by tenths of the stated probability; tenths without enough candidates are left out.
 * @param copies how often each candidate's nats are counted: more than once states too much
 */
export function reliability(
  all: readonly { isTrue: boolean; nats: number }[],
  copies: number,
  bins: number,
): (readonly [stated: number, share: number])[] {
  const sums = Array.from({ length: bins }, () => ({ stated: 0, isTrue: 0, count: 0 }));
  for (const { isTrue, nats } of all) {
    const stated = probabilityOf(copies * nats);
    const bin = sums[Math.min(bins - 1, Math.floor(stated * bins))];
    if (bin !== undefined) {
      bin.stated += stated;
      bin.isTrue += isTrue ? 1 : 0;
      bin.count += 1;
    }
  }
  return sums
    .filter(({ count }) => count >= 20)
    .map(({ stated, isTrue, count }) => [stated / count, isTrue / count] as const);
}

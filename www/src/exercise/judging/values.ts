/** Round values, as problems on paper have them. */
import { between, type Random } from "./random";

/** Between two numbers, a multiple of a step. */
export function stepped(random: Random, low: number, high: number, step: number): number {
  const steps = Math.round(between(random, low, high) / step);
  return Number((steps * step).toFixed(6));
}

/** What is said of mistakes that are made in several exercises. */
export const SAID = {
  baselineDoubled: "The baseline is doubled: the distance between the two centres counts once.",
  resultInRadians: "The number is that of radians. Multiply by 180 / π.",
  tangentsOfDegrees:
    "The tangents are those of as many radians as there are degrees. Multiply by π / 180 first.",
} as const;

/** In the figures that a solution shows. */
export function figures(value: number, count = 4): string {
  return String(Number(value.toPrecision(count)));
}

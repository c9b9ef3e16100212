/** Round values, as problems on paper have them. */
import { between, type Random } from "./random";

/** Between two numbers, a multiple of a step. */
export function stepped(random: Random, low: number, high: number, step: number): number {
  const steps = Math.round(between(random, low, high) / step);
  return Number((steps * step).toFixed(6));
}

/** In the figures that a solution shows. */
export function figures(value: number, count = 4): string {
  return String(Number(value.toPrecision(count)));
}

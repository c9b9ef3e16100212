/** Numbers as sentences say them. */
import { DEGREE } from "../../shared/linear";

/** With a real minus, and no minus before a zero. */
export function num(value: number, digits = 1): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** How many digits a number needs that moves in steps. */
export const digitsOf = (step: number): number => Math.max(0, Math.ceil(-Math.log10(step)));

export const metres = (value: number, digits = 1): string => `${num(value, digits)} m`;
export const pixels = (value: number, digits = 1): string => `${num(value, digits)} px`;
export const degrees = (radians: number, digits = 0): string => `${num(radians / DEGREE, digits)}°`;
export const place = ([x, y]: readonly [number, number], digits = 1): string =>
  `(${num(x, digits)}, ${num(y, digits)})`;

/** What is uncertain looks uncertain: the background shows through what is less probable. */

/** From this probability on a thing is drawn as certain. */
export const CERTAIN = 0.9;
/** A thing that is drawn at all can be seen. */
const LEAST_OPACITY = 0.2;

/** The probability in whole tenths, for few materials; 1 for what is certain. */
export function opacityOf(probability = 1): number {
  return probability >= CERTAIN ? 1 : Math.max(LEAST_OPACITY, Math.floor(10 * probability) / 10);
}

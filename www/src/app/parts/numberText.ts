/** Numbers as text. The browser's own way loads the rules of all languages at its first use, which holds the page up. */

/** With commas between thousands, and at most three decimals. */
export function grouped(value: number): string {
  const [whole = "", decimals] = String(Number(value.toFixed(3))).split(".");
  const text = whole.replace(/\B(?=(\d{3})+$)/g, ",");
  return decimals === undefined ? text : `${text}.${decimals}`;
}

/** With its sign, as text has it: "+0.4", "−1.3", "0.0". */
export function signed(value: number, decimals = 1): string {
  const size = Math.abs(value).toFixed(decimals);
  return Number(size) === 0 ? size : `${value < 0 ? "−" : "+"}${size}`;
}

/** "93 %"; only what is certain is 0 or 100 %. */
export function percentText(share: number): string {
  const percent = Math.round(100 * share);
  if (percent === 100 && share < 1) {
    return "> 99 %";
  }
  return percent === 0 && share > 0 ? "< 1 %" : `${percent} %`;
}

/** How long something takes, as far as anybody wants to know: "less than a minute", "about 7 minutes", "about 2.5 hours". */
export function minutesText(seconds: number): string {
  const minutes = Math.round(seconds / 60);
  if (minutes < 1) {
    return "less than a minute";
  }
  if (minutes >= 90) {
    return `about ${Math.round(minutes / 30) / 2} hours`;
  }
  return minutes === 1 ? "about a minute" : `about ${minutes} minutes`;
}

/** Of a plane against the level, by its normal; radians. */
export function slopeOf([x, y, z]: readonly [number, number, number]): number {
  return Math.atan2(Math.hypot(x, y), Math.abs(z));
}

export const degreesOf = (radians: number) => (radians * 180) / Math.PI;

/** Numbers as text. The browser's own way loads the rules of all languages at its first use, which holds the page up. */

/** With commas between thousands, and at most three decimals. */
export function grouped(value: number): string {
  const [whole = "", decimals] = String(Number(value.toFixed(3))).split(".");
  const text = whole.replace(/\B(?=(\d{3})+$)/g, ",");
  return decimals === undefined ? text : `${text}.${decimals}`;
}

export const degreesOf = (radians: number) => (radians * 180) / Math.PI;

/** A number with its unit, as a person writes it. */

/** Of each unit: what it measures, and how many of the first unit of its kind it is. */
const UNITS = {
  m: { kind: "length", factor: 1 },
  cm: { kind: "length", factor: 0.01 },
  mm: { kind: "length", factor: 0.001 },
  px: { kind: "length in the image", factor: 1 },
  deg: { kind: "angle", factor: Math.PI / 180 },
  rad: { kind: "angle", factor: 1 },
  nats: { kind: "information", factor: 1 },
  bits: { kind: "information", factor: Math.LN2 },
} as const;

export type Unit = keyof typeof UNITS;

/** What people write for a unit. */
const WORDS: Readonly<Record<string, Unit>> = {
  metre: "m",
  metres: "m",
  meter: "m",
  meters: "m",
  centimetres: "cm",
  millimetres: "mm",
  pixel: "px",
  pixels: "px",
  "°": "deg",
  degree: "deg",
  degrees: "deg",
  radian: "rad",
  radians: "rad",
  nat: "nats",
  bit: "bits",
};

export interface Quantity {
  value: number;
  unit: Unit;
}

export type Read = { quantity: Quantity } | { problem: string };

const WRITTEN = /^([-+−]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:e[-+]?\d+)?)\s*(.*)$/i;

/** Reads "12.4 cm", "12,4cm", "−3°". */
export function readQuantity(text: string): Read {
  const found = WRITTEN.exec(text.trim());
  if (found === null) {
    return { problem: 'Write a number with its unit, such as "12.5 cm".' };
  }
  const [, number = "", word = ""] = found;
  const value = Number(number.replace("−", "-").replace(",", "."));
  const unit = unitOf(word.trim());
  if (word.trim() === "") {
    return { problem: `The unit is missing: ${value} what? A number alone is no answer.` };
  }
  if (unit === null) {
    return {
      problem: `"${word.trim()}" is not a unit that is known here: ${Object.keys(UNITS).join(", ")}.`,
    };
  }
  return { quantity: { value, unit } };
}

function unitOf(word: string): Unit | null {
  const lower = word.toLowerCase().replace(/\.$/, "");
  return Object.hasOwn(UNITS, lower)
    ? (lower as Unit)
    : Object.hasOwn(WORDS, lower)
      ? (WORDS[lower] ?? null)
      : null;
}

export function kindOf(unit: Unit): string {
  return UNITS[unit].kind;
}

/** All units that measure the same. */
export function unitsLike(unit: Unit): Unit[] {
  return (Object.keys(UNITS) as Unit[]).filter((one) => kindOf(one) === kindOf(unit));
}

/** The same quantity in another unit of its kind. */
export function inUnit({ value, unit }: Quantity, other: Unit): number {
  return (value * UNITS[unit].factor) / UNITS[other].factor;
}

/** In so many figures, with its unit. */
export function quantityText({ value, unit }: Quantity, figures = 4): string {
  const rounded = Number(value.toPrecision(figures));
  return unit === "deg" ? `${rounded}°` : `${rounded} ${unit}`;
}

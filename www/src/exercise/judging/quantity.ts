/** A number with its unit, as a person writes it. */
import { DEGREE } from "../../shared/linear";

/** Of each unit: what it measures, how many of the first unit of its kind it is, and what people write for it. */
const UNITS = {
  m: { kind: "length", factor: 1, words: ["metre", "metres", "meter", "meters"] },
  cm: { kind: "length", factor: 0.01, words: ["centimetres"] },
  mm: { kind: "length", factor: 0.001, words: ["millimetres"] },
  px: { kind: "length in the image", factor: 1, words: ["pixel", "pixels"] },
  deg: { kind: "angle", factor: DEGREE, words: ["°", "degree", "degrees"] },
  rad: { kind: "angle", factor: 1, words: ["radian", "radians"] },
  nats: { kind: "information", factor: 1, words: ["nat"] },
  bits: { kind: "information", factor: Math.LN2, words: ["bit"] },
} as const;

export type Unit = keyof typeof UNITS;

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
  const units = Object.keys(UNITS) as Unit[];
  return units.find((unit) => unit === lower || UNITS[unit].words.some((one) => one === lower)) ?? null;
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

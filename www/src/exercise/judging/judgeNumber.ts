/** Judges a number with its unit: by values that are drawn for each student, and by what usual mistakes come to. */
import type { About, NamedMistake, Verdict } from "./about";
import { inUnit, kindOf, type Quantity, quantityText, readQuantity, type Unit, unitsLike } from "./quantity";
import { type Random, randomFrom } from "./random";

/** One student's values. */
export interface Draw<Name extends string = string> {
  /** With the values in it. */
  text: string;
  value: number;
  /** How it is found, with the values. */
  solution: string;
  /** What each mistake comes to, in the unit of the answer; several ways to make it are one mistake. */
  wrong: Readonly<Record<Name, readonly number[]>>;
}

export interface NumberExercise<Name extends string = string> extends About {
  kind: "number";
  unit: Unit;
  /** Share of the answer by which it may be rounded. */
  tolerance: number;
  draw(random: Random): Draw<Name>;
  /** By the name of the mistake, what was done and what is to be done instead. */
  mistakes: Readonly<Record<Name, string>>;
}

/** Keeps the names of mistakes together. */
export function numberExercise<Name extends string>(
  of: Omit<NumberExercise<Name>, "kind" | "tolerance"> & { tolerance?: number },
): NumberExercise {
  return { kind: "number", tolerance: 0.01, ...of } as unknown as NumberExercise;
}

export const WRONG_KIND = "wrong kind of unit";
export const WRONG_UNIT = "wrong unit";
export const WRONG_SIGN = "wrong sign";
export const WRONG_POWER = "a power of ten";

/** So often values are drawn anew on which two mistakes come to the same. */
const MOST_DRAWS = 500;

/** The draw of a seed. */
export function drawOf(exercise: NumberExercise, seed: number): Draw {
  const random = randomFrom(seed);
  let draw = exercise.draw(random);
  for (let i = 0; i < MOST_DRAWS && !tellsApart(exercise, draw); i += 1) {
    draw = exercise.draw(random);
  }
  return draw;
}

/** Whether no number can be taken for two things, the answer and the mistakes. */
export function tellsApart({ tolerance }: NumberExercise, { value, wrong }: Draw): boolean {
  const named = Object.entries(wrong).flatMap(([name, values]) => values.map((one) => [name, one] as const));
  const all = [["", value] as const, ...named];
  return all.every(([name, a], i) =>
    all
      .slice(i + 1)
      .every(([other, b]) => name === other || Math.abs(a - b) > tolerance * (Math.abs(a) + Math.abs(b))),
  );
}

/** Judges what was written, for the values that a seed draws. */
export function judgeNumber(exercise: NumberExercise, draw: Draw, written: string): Verdict {
  const read = readQuantity(written);
  if ("problem" in read) {
    return { kind: "form", says: read.problem };
  }
  const { quantity } = read;
  const { unit, tolerance } = exercise;
  if (kindOf(quantity.unit) !== kindOf(unit)) {
    return {
      kind: "mistake",
      name: WRONG_KIND,
      says: `${quantity.unit} measures a ${kindOf(quantity.unit)}; asked for is a ${kindOf(unit)}.`,
    };
  }
  const given = inUnit(quantity, unit);
  const isNear = (value: number, right: number) => Math.abs(value - right) <= tolerance * Math.abs(right);
  if (isNear(given, draw.value)) {
    return { kind: "right" };
  }
  return (
    namedMistake(exercise, draw, (value) => isNear(given, value)) ??
    generalMistake(quantity, { value: draw.value, unit }, isNear) ?? {
      kind: "wrong",
      says: `Not right: it may be off by ${Number((100 * tolerance).toPrecision(2))} %, and is off by more.`,
    }
  );
}

function namedMistake(
  { mistakes }: NumberExercise,
  { wrong }: Draw,
  isGiven: (value: number) => boolean,
): ({ kind: "mistake" } & NamedMistake) | null {
  const name = Object.keys(mistakes).find((one) => wrong[one]?.some(isGiven));
  return name === undefined ? null : { kind: "mistake", name, says: mistakes[name] ?? "" };
}

/** What can go wrong with any number. */
function generalMistake(
  given: Quantity,
  right: Quantity,
  isNear: (value: number, right: number) => boolean,
): Verdict | null {
  const other = unitsLike(given.unit).find(
    (unit) => unit !== given.unit && isNear(given.value, inUnit(right, unit)),
  );
  if (other !== undefined) {
    return {
      kind: "mistake",
      name: WRONG_UNIT,
      says: `The number is right in ${other}; ${quantityText(given)} is something else.`,
    };
  }
  const value = inUnit(given, right.unit);
  if (isNear(-value, right.value)) {
    return { kind: "mistake", name: WRONG_SIGN, says: "The size is right, the sign is not." };
  }
  const power = Math.round(Math.log10(Math.abs(value / right.value)));
  return power !== 0 && Math.abs(power) <= 6 && isNear(value, right.value * 10 ** power)
    ? {
        kind: "mistake",
        name: WRONG_POWER,
        says: `The figures are right, but the point is not where it should be: by 10 to the ${power}.`,
      }
    : null;
}

/** Numbers with units: the right one is taken in any unit of its kind, and each usual mistake is known by its name. */
import { describe, expect, it } from "vitest";
import {
  drawOf,
  judgeNumber,
  tellsApart,
  WRONG_KIND,
  WRONG_POWER,
  WRONG_SIGN,
  WRONG_UNIT,
} from "../../../src/exercise/judging/judgeNumber";
import { inUnit, readQuantity, type Unit, unitsLike } from "../../../src/exercise/judging/quantity";
import { NUMBERS } from "../../../src/exercise/numbers";

const SEEDS = Array.from({ length: 60 }, (_, i) => 7919 * i + 3);
const written = (value: number, unit: Unit) => `${value} ${unit}`;

describe.each(NUMBERS.map((exercise) => [exercise.name, exercise] as const))("%s", (_, exercise) => {
  const { unit, tolerance, mistakes } = exercise;

  it("takes its own answer, rounded, in every unit of its kind", () => {
    for (const seed of SEEDS) {
      const draw = drawOf(exercise, seed);
      for (const other of unitsLike(unit)) {
        const value = inUnit({ value: draw.value * (1 + 0.9 * tolerance), unit }, other);
        expect(judgeNumber(exercise, draw, written(value, other)), `seed ${seed}`).toEqual({ kind: "right" });
      }
    }
  });

  it("draws values on which no two mistakes come to the same", () => {
    expect(SEEDS.filter((seed) => !tellsApart(exercise, drawOf(exercise, seed)))).toEqual([]);
  });

  it("draws other values for another seed, and the same for the same", () => {
    const texts = new Set(SEEDS.map((seed) => drawOf(exercise, seed).text));
    expect(texts.size).toBeGreaterThan(SEEDS.length / 2);
    expect(drawOf(exercise, 5)).toEqual(drawOf(exercise, 5));
  });

  it.each(Object.keys(mistakes))("knows '%s', and takes nothing else for it", (name) => {
    for (const seed of SEEDS) {
      const draw = drawOf(exercise, seed);
      const values = draw.wrong[name] ?? [];
      expect(values.length).toBeGreaterThan(0);
      for (const value of values) {
        expect(
          judgeNumber(exercise, draw, written(value, unit)),
          `seed ${seed}: ${value} beside ${draw.value}`,
        ).toMatchObject({ kind: "mistake", name });
      }
    }
  });

  it("knows at least three mistakes, and explains each", () => {
    expect(Object.keys(mistakes).length).toBeGreaterThanOrEqual(3);
    for (const says of Object.values(mistakes)) {
      expect(says.length).toBeGreaterThan(40);
    }
    expect(Object.keys(drawOf(exercise, 1).wrong).sort()).toEqual(Object.keys(mistakes).sort());
  });

  it("refuses a number without a unit, and one with another kind of unit", () => {
    const draw = drawOf(exercise, 11);
    expect(judgeNumber(exercise, draw, String(draw.value))).toMatchObject({
      kind: "form",
      says: expect.stringMatching(/unit is missing/),
    });
    const foreign: Unit = unit === "nats" || unit === "bits" ? "m" : "nats";
    expect(judgeNumber(exercise, draw, written(draw.value, foreign))).toMatchObject({ name: WRONG_KIND });
    expect(judgeNumber(exercise, draw, written(draw.value * 1.07 + 0.003, unit)).kind).not.toBe("right");
  });

  it("shows its values and the answer in the solution", () => {
    const { solution, value } = drawOf(exercise, 21);
    const shown = [...solution.matchAll(/\d+(?:\.\d+)?/g)].map(([number]) => Number(number));
    expect(shown.some((one) => Math.abs(one - Math.abs(value)) <= 0.002 * Math.abs(value))).toBe(true);
  });
});

describe("mistakes of any number", () => {
  const [ground] = NUMBERS;
  if (ground === undefined) {
    throw new Error("there are no numbers");
  }
  const draw = drawOf(ground, 4);

  it("are a wrong unit, a wrong sign, a power of ten", () => {
    expect(judgeNumber(ground, draw, written(draw.value, "m"))).toMatchObject({ name: WRONG_UNIT });
    expect(judgeNumber(ground, draw, written(-draw.value, "cm"))).toMatchObject({ name: WRONG_SIGN });
    expect(judgeNumber(ground, draw, written(draw.value * 1e4, "cm"))).toMatchObject({ name: WRONG_POWER });
    expect(judgeNumber(ground, draw, written(draw.value * 1.3, "cm"))).toMatchObject({ kind: "wrong" });
  });
});

describe("what is written", () => {
  it.each([
    ["12.5 cm", 12.5, "cm"],
    ["12,5cm", 12.5, "cm"],
    ["−3°", -3, "deg"],
    ["1e-2 m", 0.01, "m"],
    [" .5 Pixels ", 0.5, "px"],
    ["2 nat", 2, "nats"],
  ])("%s is read", (text, value, unit) => {
    expect(readQuantity(text)).toEqual({ quantity: { value, unit } });
  });

  it.each(["", "cm", "twelve cm", "12", "12 apples", "1.2.3 m", "Infinity m", "NaN m", "12 constructor"])(
    "'%s' is not",
    (text) => {
      expect(readQuantity(text)).toHaveProperty("problem");
    },
  );
});

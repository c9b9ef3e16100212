/** All exercises together: as many as there should be, in every lesson, with terms that exist; and the sheets made of them. */
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { exercisesPage } from "../../../scripts/exercisesPage";
import { escaped, plain } from "../../../src/app/words/linkedText";
import { EXERCISES, exerciseNamed, mistakesOf } from "../../../src/exercise/exercises";
import { LESSONS } from "../../../src/exercise/judging/about";
import { drawOf } from "../../../src/exercise/judging/judgeNumber";
import { quantityText } from "../../../src/exercise/judging/quantity";
import { sheetOf } from "../../../src/exercise/page/sheet";

describe("the exercises", () => {
  it("are thirty at least, about ten of each kind, and each lesson has two", () => {
    expect(EXERCISES.length).toBeGreaterThanOrEqual(30);
    for (const kind of ["figure", "number", "function"]) {
      expect(EXERCISES.filter((one) => one.kind === kind).length).toBeGreaterThanOrEqual(10);
    }
    for (const lesson of Object.keys(LESSONS)) {
      expect(EXERCISES.filter((one) => one.lesson === lesson).length, lesson).toBeGreaterThanOrEqual(2);
    }
  });

  it("have names and titles of their own, a section of a paper, and three mistakes or more", () => {
    const names = EXERCISES.map(({ name }) => name);
    expect(new Set(names).size).toBe(names.length);
    expect(new Set(EXERCISES.map(({ title }) => title)).size).toBe(names.length);
    for (const exercise of EXERCISES) {
      expect(exercise.source, exercise.name).toMatch(/^(B99|W96) \d/);
      expect(mistakesOf(exercise).length, exercise.name).toBeGreaterThanOrEqual(3);
      expect(exerciseNamed(exercise.name)).toBe(exercise);
    }
    expect(exerciseNamed("constructor")).toBeNull();
  });
});

describe("docs/exercises.md", () => {
  it("lists them (npm run lists)", () => {
    const page = readFileSync(new URL("../../../../docs/exercises.md", import.meta.url), "utf8");
    expect(page).toBe(exercisesPage());
  });

  it("and docs/teaching.md has the code of the notebook", () => {
    const read = (path: string) => readFileSync(new URL(`../../../../${path}`, import.meta.url), "utf8");
    const { cells } = JSON.parse(read("www/package/examples/notebook.ipynb")) as {
      cells: { cell_type: string; source: string[] }[];
    };
    const [code] = cells.filter(({ cell_type }) => cell_type === "code");
    expect(read("docs/teaching.md")).toContain(`\`\`\`python\n${code?.source.join("")}\n\`\`\``);
  });
});

const figures = EXERCISES.filter(({ kind }) => kind === "figure");
const answers = new Map(figures.map(({ name }) => [name, `the answer of ${name}`]));
const sheet = { exercises: EXERCISES, seed: 12, page: "https://example.org/exercises.html" };

describe("a sheet", () => {
  const without = sheetOf({ ...sheet, answers: null });
  const withThem = sheetOf({ ...sheet, answers });

  it("has every exercise, and no answer", () => {
    for (const exercise of EXERCISES) {
      expect(without).toContain(escaped(exercise.title));
      if (exercise.kind === "number") {
        const { text, value, solution } = drawOf(exercise, 12);
        expect(without).toContain(escaped(plain(text)));
        expect(without).not.toContain(escaped(solution));
        expect(withThem).toContain(escaped(solution));
        expect(withThem).toContain(quantityText({ value, unit: exercise.unit }));
      } else {
        expect(without).toContain(escaped(plain(exercise.text)));
        expect(without).not.toContain(escaped(exercise.solution));
        expect(withThem).toContain(escaped(exercise.solution));
      }
    }
    for (const answer of answers.values()) {
      expect(without).not.toContain(answer);
      expect(withThem).toContain(answer);
    }
    expect(without).not.toContain("recognised");
  });

  it("is one file: no script, nothing to fetch, no mark of a term", () => {
    for (const text of [without, withThem]) {
      expect(text).not.toMatch(/<script|<link|<img|\[\[[a-z-]+[|\]]|undefined|NaN/);
      expect(text.match(/<section>/g)).toHaveLength(EXERCISES.length);
    }
    expect(without).toContain("https://example.org/exercises.html?seed=12#turnToRoof");
  });

  it("has other values for another number", () => {
    expect(sheetOf({ ...sheet, seed: 13, answers: null })).not.toBe(without);
    expect(sheetOf({ ...sheet, answers: null })).toBe(without);
  });
});

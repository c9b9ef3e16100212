/** The exercises: right answers are right in any form, and every usual mistake is known by its name and by no other. */
import { describe, expect, it } from "vitest";
import { type AnyFunction as AnyExercise, FUNCTIONS as EXERCISES } from "../../../src/exercise/functions";
import type { Verdict } from "../../../src/exercise/judging/about";
import { judge } from "../../../src/exercise/judging/judge";
import { randomFrom } from "../../../src/exercise/judging/random";

type Solver = (...input: unknown[]) => unknown;

const SEEDS = [1, 2, 77, 123456, 4294967295];
const COUNT = 24;

function plantedOf(exercise: AnyExercise, seed: number) {
  const random = randomFrom(seed);
  return Array.from({ length: COUNT }, () => exercise.plant(random));
}

function judged(exercise: AnyExercise, solver: Solver, seed = 5): Verdict {
  const planted = plantedOf(exercise, seed);
  return judge(
    exercise,
    planted,
    planted.map(({ input }) => solver(...structuredClone(input))),
  );
}

/** What a student would write: source text alone. */
function written(source: string, name: string): Solver {
  return new Function(`"use strict"; ${source}; return ${name};`)() as Solver;
}

const named = (name: string) => EXERCISES.find((one) => one.name === name) as AnyExercise;
const solved = (name: string) => written(named(name).solution, name);

describe.each(EXERCISES.map((exercise) => [exercise.name, exercise] as const))("%s", (name, exercise) => {
  it("takes its own solution, whatever is planted", () => {
    for (const seed of SEEDS) {
      expect(judged(exercise, solved(name), seed), `seed ${seed}`).toEqual({ kind: "right" });
    }
  });

  it("has an editor that begins with a function of its name, which is no answer", () => {
    const verdict = judged(exercise, written(exercise.starter, name));
    expect(verdict.kind).not.toBe("right");
  });

  const mistakes = Object.entries(exercise.mistakes);
  const variants = mistakes.flatMap(([mistake, { variants: all }]) =>
    all.map((variant, i) => [mistake, i, variant as Solver] as const),
  );

  it.each(variants)("knows '%s' (%i), and takes no other mistake for it", (mistake, _, variant) => {
    for (const seed of SEEDS) {
      expect(judged(exercise, variant, seed), `seed ${seed}`).toMatchObject({
        kind: "mistake",
        name: mistake,
      });
    }
    const planted = plantedOf(exercise, 9);
    const answers = planted.map(({ input }) => variant(...input));
    const taken = mistakes.filter(([, { variants: all }]) =>
      all.some((one: Solver) => planted.every(({ input }, i) => exercise.isSame(one(...input), answers[i]))),
    );
    expect(taken.map(([name]) => name)).toEqual([mistake]);
  });

  it("says what is wrong with the form of an answer", () => {
    for (const answer of [undefined, null, "F", {}, [[1, 2]], [[Number.NaN]]]) {
      expect(judged(exercise, () => answer)).toMatchObject({
        kind: "form",
        says: expect.stringMatching(/Return|divide/),
      });
    }
  });

  it("explains each mistake", () => {
    for (const [, { says }] of mistakes) {
      expect(says.length).toBeGreaterThan(40);
    }
  });
});

describe("answers of other forms", () => {
  const scaled = (name: string, factor: number) => {
    const solve = solved(name) as (...input: unknown[]) => number[][];
    return (...input: unknown[]) => solve(...input).map((row) => row.map((value) => value * factor));
  };

  it.each([-3.7e-9, 1e12])("may have any scale where it is free: %d", (factor) => {
    expect(judged(named("fundamentalFromProjections"), scaled("fundamentalFromProjections", factor))).toEqual(
      {
        kind: "right",
      },
    );
    expect(judged(named("homographyOfPlane"), scaled("homographyOfPlane", factor))).toEqual({
      kind: "right",
    });
  });

  it("a mistake is known in any scale, too", () => {
    const scaledMistake: Solver = (...input) => {
      const f = (solved("fundamentalFromProjections") as (...of: unknown[]) => number[][])(...input);
      return f.map((_, i) => f.map((row) => -0.01 * (row[i] as number)));
    };
    expect(judged(named("fundamentalFromProjections"), scaledMistake)).toMatchObject({ name: "transposed" });
  });
});

/** Written as students write, and not as the exercises themselves have them. */
const WRITTEN: readonly (readonly [exercise: string, mistake: string, source: string])[] = [
  [
    "ncc",
    "mean not subtracted",
    "function ncc(a,b){let s=0,p=0,q=0;for(let i=0;i<a.length;i++){s+=a[i]*b[i];p+=a[i]**2;q+=b[i]**2}return s/Math.sqrt(p*q)}",
  ],
  [
    "ncc",
    "divided by nothing",
    "function ncc(a,b){const m=w=>w.reduce((x,y)=>x+y)/w.length,A=m(a),B=m(b);let s=0,p=0,q=0;a.forEach((v,i)=>{s+=(Math.abs(v-A)<1e-9?0:v-A)*(b[i]-B);p+=(Math.abs(v-A)<1e-9?0:v-A)**2;q+=(b[i]-B)**2});return s/Math.sqrt(p*q)}",
  ],
  [
    "homographyOfPlane",
    "R transposed",
    `${"function homographyOfPlane(K,L,R,t,n,d){"}const S=[0,1,2].map(i=>[0,1,2].map(j=>R[j][i]));return right(K,L,S,t,n,d)}`,
  ],
  [
    "homographyOfPlane",
    "wrong sign",
    "function homographyOfPlane(K,L,R,t,n,d){return right(K,L,R,t.map(v=>-v),n,d)}",
  ],
  [
    "triangulate",
    "half a pixel",
    "function triangulate(P,x,Q,y){const h=v=>v.map(w=>w-0.5);return right(P,h(x),Q,h(y))}",
  ],
];

describe("what students write", () => {
  it.each(WRITTEN)("%s: %s", (exercise, mistake, source) => {
    const right = named(exercise).solution.replace(`function ${exercise}`, "function right");
    const solver = written(`${right}\n${source}`, exercise);
    expect(judged(named(exercise), solver)).toMatchObject({ kind: "mistake", name: mistake });
  });

  it("is not taken for a mistake where it is another: an error in the unit is said", () => {
    const exercise = named("triangulate");
    const off: Solver = (...input) =>
      (solved("triangulate")(...input) as number[]).map((value) => value + 0.5);
    const verdict = judged(exercise, off);
    expect(verdict).toMatchObject({ kind: "wrong" });

    expect(verdict.kind === "wrong" && verdict.says).toMatch(/24 of 24 configurations.*0\.866 m/);
  });

  it("is not right where it is right by chance: four homogeneous numbers, one number for all", () => {
    const four: Solver = (...input) => [...(solved("triangulate")(...input) as number[]), 1];
    expect(judged(named("triangulate"), four)).toMatchObject({
      kind: "form",
      says: expect.stringMatching(/homogeneous/),
    });
    expect(judged(named("ncc"), () => 0)).toMatchObject({ kind: "wrong" });
  });
});

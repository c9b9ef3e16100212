/** All exercises, in the order of their lessons. */
import { FIGURE_EXERCISES } from "./figures/index";
import type { FigureExercise } from "./figures/judgeFigure";
import { type AnyFunction, FUNCTIONS } from "./functions/index";
import { LESSONS, type Lesson, type NamedMistake } from "./judging/about";
import { drawOf, type NumberExercise } from "./judging/judgeNumber";
import { NUMBERS } from "./numbers/index";

export type AnyExercise = AnyFunction | NumberExercise | FigureExercise;

const ORDER = Object.keys(LESSONS) as readonly Lesson[];

/** Of a lesson: first in the figure, then with numbers, then with code. */
export const EXERCISES: readonly AnyExercise[] = ORDER.flatMap((lesson) =>
  [...FIGURE_EXERCISES, ...NUMBERS, ...FUNCTIONS].filter((one) => one.lesson === lesson),
);

export function exerciseNamed(name: string | null): AnyExercise | null {
  return EXERCISES.find((one) => one.name === name) ?? null;
}

/** How an exercise is done, in a word. */
export const KIND_WORDS: Readonly<Record<AnyExercise["kind"], string>> = {
  figure: "figure",
  number: "number",
  function: "code",
};

/** What is to be done; in numbers that a seed draws. */
export function taskText(exercise: AnyExercise, seed: number): string {
  return exercise.kind === "number" ? drawOf(exercise, seed).text : exercise.text;
}

/** The usual mistakes that an exercise knows. */
export function mistakesOf(exercise: AnyExercise): readonly NamedMistake[] {
  const known: Readonly<Record<string, string | { says: string }>> = exercise.mistakes;
  return Object.entries(known).map(([name, of]) => ({ name, says: typeof of === "string" ? of : of.says }));
}

/**
 * Judges functions that are to be written. An answer is right where it holds for planted configurations, whatever its formula is; a wrong
 * one is compared with what the usual mistakes would have answered.
 */
import type { About, Verdict } from "./about";
import type { Random } from "./random";

interface Planted<Input extends readonly unknown[], Answer> {
  input: Input;
  /** How far an answer is from what was planted, in the unit of the exercise. */
  error(answer: Answer): number;
}

export interface Mistake<Input extends readonly unknown[], Answer> {
  /** What was done, and what is to be done instead. */
  says: string;
  /** What it answers; several ways to make it are one mistake. */
  variants: readonly ((...input: Input) => Answer)[];
}

export interface FunctionExercise<Input extends readonly unknown[], Answer> extends About {
  kind: "function";
  text: string;
  /** What stands in the editor first. */
  starter: string;
  solution: string;
  /** Of errors. */
  unit: string;
  /** Up to this error an answer is right: far above rounding, far below a mistake. */
  limit: number;
  plant(random: Random): Planted<Input, Answer>;
  /** What is wrong with the form of an answer; null where it can be judged. */
  formProblem(answer: unknown): string | null;
  isSame(a: Answer, b: Answer): boolean;
  /** By their names. */
  mistakes: Readonly<Record<string, Mistake<Input, Answer>>>;
}

export function functionExercise<Input extends readonly unknown[], Answer>(
  of: Omit<FunctionExercise<Input, Answer>, "kind">,
): FunctionExercise<Input, Answer> {
  return { kind: "function", ...of };
}

/** Judges the answers to planted configurations, one each. */
export function judge<Input extends readonly unknown[], Answer>(
  exercise: FunctionExercise<Input, Answer>,
  planted: readonly Planted<Input, Answer>[],
  answers: readonly unknown[],
): Verdict {
  for (const answer of answers) {
    const problem = exercise.formProblem(answer);
    if (problem !== null) {
      return { kind: "form", says: problem };
    }
  }
  const given = answers as readonly Answer[];
  const errors = planted.map((one, i) => errorOf(one, given[i] as Answer));
  if (errors.every((error) => error <= exercise.limit)) {
    return { kind: "right" };
  }
  const made = Object.entries(exercise.mistakes).find(([, { variants }]) =>
    variants.some((variant) =>
      planted.every((one, i) => exercise.isSame(variant(...one.input), given[i] as Answer)),
    ),
  );
  if (made !== undefined) {
    const [name, { says }] = made;
    return { kind: "mistake", name, says };
  }
  const error = Math.max(...errors);
  const count = errors.filter((one) => one > exercise.limit).length;
  return {
    kind: "wrong",
    says: `Not right in ${count} of ${errors.length} configurations; the largest error is ${errorWords(error, exercise.unit)}.`,
  };
}

/** What is no number is infinitely wrong. */
function errorOf<Input extends readonly unknown[], Answer>(
  { error }: Planted<Input, Answer>,
  answer: Answer,
): number {
  const found = error(answer);
  return Number.isFinite(found) ? found : Number.POSITIVE_INFINITY;
}

function errorWords(error: number, unit: string): string {
  return Number.isFinite(error)
    ? `${Number(error.toPrecision(3))}${unit === "" ? "" : ` ${unit}`}`
    : "beyond measure";
}

/** Says what is wrong with an answer that should be a finite number. */
export function numberProblem(answer: unknown, of: string): string | null {
  return isNumber(answer) ? null : `Return one number, ${of}; this is ${described(answer)}.`;
}

/** Says what is wrong with an answer that should be rows of finite numbers. */
export function matrixProblem(answer: unknown, rows: number, columns: number): string | null {
  const isMatrix =
    Array.isArray(answer) && answer.length === rows && answer.every((row) => isVector(row, columns));
  return isMatrix ? null : `Return ${rows} rows of ${columns} numbers; this is ${described(answer)}.`;
}

/** Says what is wrong with an answer that should be so many finite numbers, and `what` if its last one is still homogeneous. */
export function vectorProblem(answer: unknown, length: 2 | 3, what: string): string | null {
  if (Array.isArray(answer) && answer.length === length + 1) {
    const [all, last, asked] = length === 2 ? ["three", "third", "two"] : ["four", "fourth", "three"];
    return `These are ${all} numbers: the ${what} is homogeneous still. Divide by the ${last}, and return ${asked}.`;
  }
  return isVector(answer, length) ? null : `Return ${length} numbers; this is ${described(answer)}.`;
}

export function isVector(answer: unknown, length: number): boolean {
  return Array.isArray(answer) && answer.length === length && answer.every(isNumber);
}

function isNumber(value: unknown): boolean {
  return typeof value === "number" && Number.isFinite(value);
}

export function described(value: unknown): string {
  if (value === undefined) {
    return "nothing: is there a return";
  }
  const text = JSON.stringify(value, (_, one: unknown) =>
    typeof one === "number" && !Number.isFinite(one) ? String(one) : one,
  );
  return text !== undefined && text.length > 80 ? `${text.slice(0, 77)}...` : (text ?? typeof value);
}

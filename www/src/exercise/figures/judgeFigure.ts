/** Exercises that are done in a live figure: by what is picked or turned there, or by what is read off it. */
import type { FigureState } from "../../element/figureState";
import type { Question } from "../../element/RidgelineFigure";
import type { Args, Result } from "../../shared/calls";
import type { Figure } from "../../stages/figure";
import type { About, Verdict } from "../judging/about";
import type { Unit } from "../judging/quantity";

/** The figure: what it shows, and the core that it asks. */
export interface Asked {
  shown: Figure;
  /** Null where the core cannot answer. */
  ask<K extends Question>(call: K, ...of: Args<K>): Promise<Result<K> | null>;
}

/** What a student gives beside the figure itself. */
type Asks =
  /** Nothing: the figure's state is the answer. */
  | { by: "state" }
  | { by: "choice"; choices(shown: Figure): readonly string[] }
  | { by: "number"; unit: Unit };

/** Right; one of the usual mistakes, by its name; nothing that can be judged, and why; or wrong in another way, and how. */
export type Outcome = "right" | { mistake: string } | { form: string } | { wrong: string };

export interface FigureAnswer {
  words: string;
  /** Where the figure then is. */
  state?: Partial<FigureState>;
  /** What is chosen or written. */
  given?: string;
}

export interface FigureExercise extends About {
  kind: "figure";
  text: string;
  figure: string;
  asks: Asks;
  /** Where the figure is when the exercise begins: found in the scene, by its truth. */
  begin(of: Asked): Promise<Partial<FigureState>>;
  judge(of: Asked, given: string): Promise<Outcome>;
  answer(of: Asked): Promise<FigureAnswer>;
  /** How the answer is found, wherever it is asked. */
  solution: string;
  mistakes: Readonly<Record<string, string>>;
}

/** An exercise that asks for nothing beside the figure's state, where it does not say otherwise. */
export function figureExercise(of: Omit<FigureExercise, "kind" | "asks"> & { asks?: Asks }): FigureExercise {
  return { kind: "figure", asks: { by: "state" }, ...of };
}

/** The first of some mistakes that was made; null where none was. */
export function mistakeAmong(made: Readonly<Record<string, boolean>>): Outcome | null {
  const mistake = Object.keys(made).find((name) => made[name]);
  return mistake === undefined ? null : { mistake };
}

export async function judgeFigure(exercise: FigureExercise, of: Asked, given: string): Promise<Verdict> {
  const outcome = await exercise.judge(of, given);
  if (outcome === "right") {
    return { kind: "right" };
  }
  if ("form" in outcome) {
    return { kind: "form", says: outcome.form };
  }
  if ("wrong" in outcome) {
    return { kind: "wrong", says: outcome.wrong };
  }
  return { kind: "mistake", name: outcome.mistake, says: exercise.mistakes[outcome.mistake] ?? "" };
}

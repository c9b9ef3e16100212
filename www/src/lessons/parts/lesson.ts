/** What a lesson is: screens of one idea each, with a formula beside the thing that moves, and a question before the answer. */
import type { ComponentType } from "preact";

export interface Lesson {
  /** In addresses, and in exercises that belong to it. */
  id: string;
  title: string;
  /** What one knows after it, in one sentence. */
  aim: string;
  minutes: number;
  /** Papers and sections that it teaches. */
  papers: string;
  screens: readonly Screen[];
}

export interface Screen {
  id: string;
  title: string;
  /** Paragraphs, with $formulas$ and *emphasis*; of what is shown, so they may change with it. */
  prose: () => readonly string[];
  formula?: () => string;
  /** Drawn from the reader's own numbers; before the answer is revealed it must not show it. */
  figure: ComponentType<{ isRevealed: boolean }>;
  /** The sentence that changes with the number. */
  says?: () => string;
  predict?: Prediction;
  /** Shown on the reader's project, or on the demo. */
  isReal?: boolean;
}

/** What the reader commits to before the answer is shown. */
export type Prediction =
  | { kind: "choice"; question: string; options: readonly string[]; right: () => number; why: () => string }
  | {
      kind: "estimate";
      question: string;
      unit: string;
      range: readonly [min: number, max: number, step: number];
      truth: () => number;
      /** Off by no more than this is right. */
      within: number;
      why: () => string;
    }
  /** The reader places something in the figure itself. */
  | { kind: "place"; question: string; how: () => string };

/** A screen that is shown on the reader's project, or on the demo. */
export function onScene(
  id: string,
  title: string,
  figure: Screen["figure"],
  prose: readonly string[],
  formula?: string,
): Screen {
  const written = formula === undefined ? {} : { formula: () => formula };
  return { id, title, prose: () => prose, figure, ...written, isReal: true };
}

/** All that a screen says, of the state that it is in now: what has to be readable. */
export function wordsOf({ prose, says, predict, formula }: Screen): string[] {
  const asked =
    predict === undefined
      ? []
      : [
          predict.question,
          ...(predict.kind === "place" ? [predict.how()] : [predict.why()]),
          ...(predict.kind === "choice" ? predict.options : []),
        ];
  return [
    ...prose(),
    ...(says === undefined ? [] : [says()]),
    ...asked,
    ...(formula === undefined ? [] : [`$${formula()}$`]),
  ];
}

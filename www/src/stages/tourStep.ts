/** Steps of the guided tour in a stage's tab, in the numbers of what was picked: `<name>/tour.ts`, gathered by the tour. */
import { effect } from "@preact/signals";
import { type SelectionDetail, selectionDetail } from "../app/state/selectionDetail";
import { tourStep } from "../app/state/tour";
import type { Results } from "./list";

export interface StageStep {
  title: string;
  text: string;
  question: string;
  /** What is said once the answer was found, in the numbers of what was picked. */
  answer: () => string;
  /** Why what is picked is not the answer; null where nothing is picked. */
  hint?: () => string | null;
  /** The control that the question is about: the style sheet marks it, wherever it stands. */
  pointsTo?: "growing" | "theta" | "other-side" | "camera";
  /** Selects what the step is about. */
  prepare?: () => void;
  /** Has the student found it? Read from the state of the views alone. */
  isFound: () => boolean;
}

/** What a step says of what is picked: nothing, and it is not found, while there is nothing of that kind. */
export function ofPicked<Picked>(
  picked: () => Picked | null,
  says: {
    answer(of: Picked): string;
    hint?(of: Picked): string;
    isFound(of: Picked): boolean;
  },
): Pick<StageStep, "answer" | "hint" | "isFound"> {
  const asked = <T>(ask: ((of: Picked) => T) | undefined, otherwise: T) => {
    const of = picked();
    return of === null || ask === undefined ? otherwise : ask(of);
  };
  return {
    answer: () => asked(says.answer, ""),
    hint: () => asked<string | null>(says.hint, null),
    isFound: () => asked(says.isFound, false),
  };
}

/** Whether the tour is still at the step of now: the core takes its time to answer. */
export function stay(): () => boolean {
  const step = tourStep.peek();
  return () => tourStep.peek() === step;
}

/** Resolves once the figures know something of the selection. */
export function known(isKnown: (detail: SelectionDetail) => boolean): Promise<void> {
  return new Promise((resolve) => {
    const stop = effect(() => {
      if (isKnown(selectionDetail.value)) {
        queueMicrotask(() => stop());
        resolve();
      }
    });
  });
}

/** The 3D lines at the sides of facets. */
export function roofLines({ facets }: Pick<Results, "facets">): ReadonlySet<number> {
  return new Set(facets?.flatMap(({ lines }) => lines ?? []));
}

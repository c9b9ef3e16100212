/** What was done in this visit, step by step, and what was taken back: one list for the whole page. */
import { type ReadonlySignal, signal } from "@preact/signals";
import { dismissOffers } from "../state/notices";
import { files, type ProjectState, presentProject } from "../state/project";
import { keepFound } from "./foundBefore";

export interface Step {
  what: string;
  /** The path of a parameter, or the project. */
  about: string;
  /** How all was before the step; of a step that was taken back, after it. */
  state: ProjectState;
}

/** So many are kept. */
const MOST_STEPS = 50;

const done = signal<readonly Step[]>([]);
const undone = signal<readonly Step[]>([]);

/** The last step is taken back first. */
export const steps: ReadonlySignal<readonly Step[]> = done;
/** The step that was taken back last is done again first. */
export const undoneSteps: ReadonlySignal<readonly Step[]> = undone;

/** What notices offer: they are about the last step, and go with it. */
export const UNDO = "Undo";
/** On what is outdated once files have come: a run makes it up to date. */
export const UNDO_ADDING = "Undo adding";

/** Notes how all is, before it changes. */
export function noteStep(what: string, about = "project"): void {
  if (files.value.length > 0) {
    keepFound();
    dismissOffers(UNDO);
    dismissOffers(UNDO_ADDING);
    done.value = [...done.value, { what, about, state: presentProject() }].slice(-MOST_STEPS);
    undone.value = [];
  }
}

/** Moves the last step to the other list, and returns it with the state that is wanted. */
export function takeStep(way: "undo" | "redo"): Step | null {
  const [from, to] = way === "undo" ? [done, undone] : [undone, done];
  const step = from.value.at(-1);
  if (step === undefined) {
    return null;
  }
  keepFound();
  dismissOffers(UNDO);
  dismissOffers(UNDO_ADDING);
  from.value = from.value.slice(0, -1);
  to.value = [...to.value, { ...step, state: presentProject() }];
  return step;
}

/** How far the guided tour is. */
import { type ReadonlySignal, signal } from "@preact/signals";

const step = signal<number | null>(null);

/** The step of the guided tour; null while it is closed. */
export const tourStep: ReadonlySignal<number | null> = step;

export function showTourStep(index: number | null): void {
  step.value = index;
}

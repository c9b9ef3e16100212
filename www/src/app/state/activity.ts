/** What the worker is busy with. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { runningStage } from "./stages";

const what = signal("");

/** What the worker is doing besides stages; empty when idle. */
export const activity: ReadonlySignal<string> = what;
export const isBusy = computed(() => activity.value !== "" || runningStage.value !== null);

export function beginActivity(name: string): void {
  what.value = name;
}

/** Ends an activity, unless another one has begun since. */
export function endActivity(name: string): void {
  if (what.value === name) {
    what.value = "";
  }
}

export function endAllActivity(): void {
  what.value = "";
}

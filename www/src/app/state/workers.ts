/** How many workers share a stage. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { automaticWorkers } from "../../core/workerCount";
import { scene } from "./scene";

const chosen = signal(0);

/** How many workers the person wants; 0: as many as are of use. */
export const chosenWorkers: ReadonlySignal<number> = chosen;
export const usefulWorkers = computed(() => {
  const views = scene.value?.views ?? [];
  const pixels = views.reduce((sum, { width, height }) => sum + width * height, 0);
  return automaticWorkers(navigator.hardwareConcurrency ?? 1, pixels);
});
export const workers = computed(() => chosenWorkers.value || usefulWorkers.value);

export function chooseWorkers(count: number): void {
  chosen.value = count;
}

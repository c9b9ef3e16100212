/** Whether a kept result stands beside the present one in space, or its outlines over it. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { keptResult } from "../state/keptResult";
import type { Tab } from "../state/methods";
import { tab } from "../state/viewState";
import { throughView } from "./Photograph";

/** What the person wants. */
const wanted = signal(true);
export const wantsBeside: ReadonlySignal<boolean> = wanted;

export function standBeside(beside: boolean): void {
  wanted.value = beside;
}

/** Tabs that show what a kept result holds. */
const TABS_OF_RESULTS: readonly Tab[] = ["facets", "refinement", "rectangles", "model"];

export const canStandBeside = computed(
  () => keptResult.value !== null && TABS_OF_RESULTS.includes(tab.value),
);
export const isBeside = computed(
  () => canStandBeside.value && wantsBeside.value && throughView.value === null,
);

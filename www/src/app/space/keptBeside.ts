/** Whether a kept result stands beside the present one in space, or its outlines over it. */
import { computed, signal } from "@preact/signals";
import { keptResult, type Tab, tab } from "../state/state";
import { through } from "./Photograph";

/** What the person wants. */
export const wantsBeside = signal(true);

/** Tabs that show what a kept result holds. */
const TABS_OF_RESULTS: readonly Tab[] = ["facets", "refinement", "rectangles", "model"];

export const canStandBeside = computed(
  () => keptResult.value !== null && TABS_OF_RESULTS.includes(tab.value),
);
export const isBeside = computed(() => canStandBeside.value && wantsBeside.value && through.value === null);

/** Whether a kept result stands beside the present one in space, or its outlines over it. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { pageOf } from "../../../stages/pages";
import { keptResult } from "../../state/keptResult";
import { tab } from "../../state/viewState";
import { throughView } from "./Photograph";

/** What the person wants. */
const wanted = signal(true);
export const wantsBeside: ReadonlySignal<boolean> = wanted;

export function standBeside(beside: boolean): void {
  wanted.value = beside;
}

/** Only tabs that show what a kept result holds. */
export const canStandBeside = computed(() => {
  const { shows = [] } = pageOf(tab.value);
  return keptResult.value !== null && (shows.includes("facets") || shows.includes("model"));
});
export const isBeside = computed(
  () => canStandBeside.value && wantsBeside.value && throughView.value === null,
);

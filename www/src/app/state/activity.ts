/** What the page is busy with: one action at a time, in one of its phases. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";

/** Compiling the core; reading and loading a project; running stages; writing a file. */
export type Phase = "start" | "load" | "run" | "save";

const going = signal<{ phase: Phase; words: string } | null>(null);

/** The phase of the action that is going on; null when idle. */
export const phase: ReadonlySignal<Phase | null> = computed(() => going.value?.phase ?? null);
/** What is being done besides stages, in words; empty when idle. */
export const activity: ReadonlySignal<string> = computed(() => going.value?.words ?? "");
export const isBusy: ReadonlySignal<boolean> = computed(() => going.value !== null);

export function showActivity(now: Phase, words: string): void {
  going.value = { phase: now, words };
}

export function showIdle(): void {
  going.value = null;
}

/** The stages of the chosen method: how far each is, and how many are up to date. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { StageName } from "../../shared/stages";

export type StageStatus = "waiting" | "running" | "done" | "outdated" | "failed";

export interface StageState {
  name: StageName;
  status: StageStatus;
  /** 0 to 1 while running. */
  fraction: number;
  seconds: number | null;
  counts: Record<string, number>;
  warnings: string[];
}

const all = signal<StageState[]>([]);
const fresh = signal(0);

export const stages: ReadonlySignal<StageState[]> = all;
/** How many stages, from the first, the worker has run with the present files and parameters. */
export const freshStages: ReadonlySignal<number> = fresh;
export const runningStage = computed(
  () => stages.value.find((stage) => stage.status === "running")?.name ?? null,
);

/** The stages of another method begin anew; the same ones stay as they are. */
export function replaceStages(names: readonly StageName[]): void {
  if (names.join() !== all.value.map(({ name }) => name).join()) {
    all.value = names.map(freshStage);
  }
}

export function updateStage(name: string, change: Partial<StageState>): void {
  all.value = all.value.map((stage) => (stage.name === name ? { ...stage, ...change } : stage));
}

/** What stages found in an earlier visit is shown again; the worker has it not. */
export function restoreStages(kept: readonly StageState[]): void {
  fresh.value = 0;
  all.value = kept.map((stage) => (stage.status === "running" ? freshStage(stage.name) : stage));
}

/** None has run. */
export function restartStages(): void {
  fresh.value = 0;
  all.value = all.value.map(({ name }) => freshStage(name));
}

/** What was running waits again. */
export function haltStages(): void {
  all.value = all.value.map((stage) =>
    stage.status === "running" ? { ...stage, status: "waiting", fraction: 0 } : stage,
  );
}

/** Of the stages that were outdated since the present one began, the first. */
let outdatedSince = Number.POSITIVE_INFINITY;

/** A stage begins, with the parameters as they are now. */
export function beginStage(position: number): void {
  fresh.value = position;
  outdatedSince = Number.POSITIVE_INFINITY;
}

/** It has ended; parameters that were changed meanwhile make it, or earlier ones, outdated at once. */
export function endStage(position: number): void {
  fresh.value = position + 1;
  if (outdatedSince <= position) {
    outdateStages(outdatedSince);
  }
}

/** The results of this stage and those after it are out of date. */
export function outdateStages(from: number): void {
  outdatedSince = Math.min(outdatedSince, from);
  fresh.value = Math.min(fresh.value, from);
  all.value = all.value.map((stage, i) =>
    i >= from && stage.status === "done" ? { ...stage, status: "outdated" } : stage,
  );
}

export function setFreshStages(count: number): void {
  fresh.value = count;
}

function freshStage(name: StageName): StageState {
  return { name, status: "waiting", fraction: 0, seconds: null, counts: {}, warnings: [] };
}

/** What was found in this visit: shown again when files, wishes and parameters are what they were then. */
import type { InputFile } from "../../shared/calls";
import { phase } from "../state/activity";
import { files, runOptions } from "../state/project";
import { scene } from "../state/scene";
import { freshStages, setFreshStages, stages } from "../state/stages";
import { select } from "../state/viewState";
import { dropResults, heldResults } from "./session";
import { changesOf, presentResults, type StoredResults, showStoredResults } from "./storedResults";

interface Kept {
  found: StoredResults;
  /** What the worker held, and how many stages of it were up to date. */
  held: object | null;
  fresh: number;
}

/** So much is kept, megabytes; beyond it what is oldest is dropped. Assumption: a tenth of a small laptop's memory. */
const MOST_MB = 400;

/** By what was worked on; the newest last. */
const kept = new Map<string, Kept>();

/** Keeps what is shown, before something else is; not where a change has outdated it already. */
export function keepFound(): void {
  const isCurrent = stages.value.every(({ status }) => status !== "outdated" && status !== "running");
  const found = isCurrent ? presentResults() : null;
  if (found !== null) {
    const of = presentInput();
    kept.delete(of);
    kept.set(of, { found, held: heldResults(), fresh: freshStages.value });
    dropOldest();
  }
}

/** Shows what was found of the present files, wishes and parameters, if anything was; a run that goes on has its own. */
export function showFound(): boolean {
  const before = kept.get(presentInput());
  const isReady = scene.value !== null || runOptions.value.tileM !== null;
  if (before === undefined || !isReady || phase.value === "run") {
    return false;
  }
  const fresh = freshStages.value;
  showStoredResults(before.found);
  select(null);
  if (before.held !== null && before.held === heldResults()) {
    // Nothing has run since.
    setFreshStages(before.fresh);
  } else {
    // Of the first stages the worker holds the same.
    setFreshStages(fresh);
    dropResults();
  }
  return true;
}

const numbers = new WeakMap<readonly InputFile[], number>();
let lastNumber = 0;

function presentInput(): string {
  const all = files.value;
  if (!numbers.has(all)) {
    lastNumber += 1;
    numbers.set(all, lastNumber);
  }
  return JSON.stringify([numbers.get(all), runOptions.value, changesOf()]);
}

function dropOldest(): void {
  const counted = new Set<unknown>();
  let bytes = 0;
  for (const [of, { found }] of [...kept].reverse()) {
    const { main, regions } = found.results;
    // Stages that did not run again have the same results: they are there once.
    for (const one of [...Object.values(main), ...Object.values(regions)].filter(
      (one) => !counted.has(one),
    )) {
      counted.add(one);
      bytes += bytesOf(one);
    }
    if (bytes > MOST_MB * 1e6) {
      kept.delete(of);
    }
  }
}

const sizes = new WeakMap<object, number>();

/** About how much memory a result takes. */
function bytesOf(value: unknown): number {
  if (typeof value !== "object" || value === null) {
    return 8;
  }
  const known = sizes.get(value);
  if (known !== undefined) {
    return known;
  }
  const inside = (one: unknown): number =>
    ArrayBuffer.isView(one)
      ? one.byteLength
      : typeof one === "object" && one !== null
        ? Object.values(one).reduce((sum: number, part) => sum + inside(part), 16)
        : 8;
  const bytes = inside(value);
  sizes.set(value, bytes);
  return bytes;
}

/** What the other methods found of the same input: shown again when one of them is chosen, as long as the page is open. */
import type { Method } from "../../shared/stages";
import { method } from "../state/parameters";
import { mainResults } from "../state/results";
import { freshStages, setFreshStages } from "../state/stages";
import { showTab } from "../state/viewState";
import { dropResults, heldResults } from "./session";
import { presentResults, type StoredResults, showStoredResults } from "./storedResults";

interface Kept {
  found: StoredResults;
  /** What the worker held, and how many stages of it were up to date. */
  held: object | null;
  fresh: number;
}

const kept = new Map<Method, Kept>();

/** Another method is about to be chosen. */
export function keepMethod(): void {
  const found = presentResults();
  if (found !== null) {
    kept.set(method.value, { found, held: heldResults(), fresh: freshStages.value });
  }
}

/** Shows what the present method has found before, if anything. */
export function showKeptMethod(): void {
  const before = kept.get(method.value);
  if (before === undefined) {
    return;
  }
  showStoredResults(before.found);
  if (before.held === heldResults()) {
    // Nothing has run since.
    setFreshStages(before.fresh);
  } else {
    dropResults();
  }
  if (mainResults.value.glb !== null) {
    showTab("model");
  }
}

/** The input is another one. */
export function forgetMethods(): void {
  kept.clear();
}

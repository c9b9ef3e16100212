/** How large the page writes: the usual size, until the person chooses. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import { keep, kept } from "./keptChoice";

/** Sizes of text and controls: the second is for projectors. */
const SCALES = [1, 1.15, 1.3, 1.5] as const;
const SCALE_KEY = "ridgeline.text";

const chosen = signal<number>(1);

/** How large text and lines are: for projectors more than 1. */
export const textScale: ReadonlySignal<number> = chosen;

/** Writes as large as in the last visit, and has the style sheets follow. */
export function restoreTextScale(): void {
  chosen.value = storedScale();
  effect(() => {
    document.documentElement.style.setProperty("--scale", String(textScale.value));
  });
}

/** The next larger text; after the largest, the usual one. */
export function biggerText(): void {
  const next = SCALES[(SCALES.indexOf(textScale.value as (typeof SCALES)[number]) + 1) % SCALES.length] ?? 1;
  chosen.value = next;
  keep(SCALE_KEY, String(next));
}

function storedScale(): number {
  const stored = Number(kept(SCALE_KEY));
  return SCALES.find((scale) => scale === stored) ?? 1;
}

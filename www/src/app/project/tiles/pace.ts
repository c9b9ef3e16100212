/** How fast tiles are worked off on this computer. */
import { type ReadonlySignal, signal } from "@preact/signals";

/** Seconds that a megapixel takes one worker, as long as no tile has told. Measured: docs/results/page.md. */
const ASSUMED = 4;

const measured = signal<{ seconds: number; megapixels: number }>({ seconds: 0, megapixels: 0 });
const pace = signal(ASSUMED);

export const secondsPerMegapixel: ReadonlySignal<number> = pace;

/** A tile of so many megapixels took so long. */
export function noteTile(seconds: number, megapixels: number): void {
  const { seconds: before, megapixels: read } = measured.peek();
  measured.value = { seconds: before + seconds, megapixels: read + megapixels };
  if (measured.peek().megapixels > 0) {
    pace.value = measured.peek().seconds / measured.peek().megapixels;
  }
}

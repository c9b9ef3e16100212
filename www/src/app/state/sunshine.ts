/** How long the sun shines on each face of the model, once somebody wants to see it. */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { Sunshine } from "../../shared/records";

interface Found {
  /** The results that it belongs to. */
  of: object;
  /** Null where it cannot be known. */
  sunshine: readonly Sunshine[] | null;
}

const present = signal<Found | null>(null);
export const foundSunshine: ReadonlySignal<Found | null> = present;

export function setSunshine(found: Found): void {
  present.value = found;
}

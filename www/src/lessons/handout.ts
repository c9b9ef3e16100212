/** All screens of a lesson below each other: for paper, and for who wants to see them so. */
import { type ReadonlySignal, signal } from "@preact/signals";
import { options } from "preact";

const wanted = signal(false);
export const isHandout: ReadonlySignal<boolean> = wanted;

export function toggleHandout(): void {
  wanted.value = !wanted.value;
}

/** Whatever is shown, the printer gets all of the lesson. */
export function followPrinting(): void {
  let before = false;
  const now = (isWanted: boolean) => {
    // The printer does not wait for the next turn.
    const usual = options.debounceRendering;
    options.debounceRendering = (draw) => draw();
    wanted.value = isWanted;
    if (usual === undefined) {
      delete options.debounceRendering;
    } else {
      options.debounceRendering = usual;
    }
  };
  window.addEventListener("beforeprint", () => {
    before = wanted.peek();
    now(true);
  });
  window.addEventListener("afterprint", () => now(before));
}

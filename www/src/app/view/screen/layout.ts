/** How much room there is, counted in the size of the text: large type needs another layout as a small screen does. */
import { computed, effect, type ReadonlySignal, signal } from "@preact/signals";
import { textScale } from "../../state/textScale";

/** "phone": no workbench; "stacked": the side columns below the views; "tight": narrow columns beside them. */
type Layout = "phone" | "stacked" | "tight" | "wide";

/** CSS pixels: below this a screen is held in the hand. */
const PHONE_PX = 600;
/** Multiples of the usual text size's CSS pixels. */
const STACKED_BELOW = 940;
const TIGHT_BELOW = 1180;

const width = signal(typeof window === "undefined" ? TIGHT_BELOW : window.innerWidth);

export const layout: ReadonlySignal<Layout> = computed(() => layoutFor(width.value, textScale.value));
export const isPhone = computed(() => layout.value === "phone");

export function layoutFor(widthPx: number, scale: number): Layout {
  if (widthPx < PHONE_PX) {
    return "phone";
  }
  const room = widthPx / scale;
  return room < STACKED_BELOW ? "stacked" : room < TIGHT_BELOW ? "tight" : "wide";
}

if (typeof window !== "undefined") {
  window.addEventListener("resize", () => {
    width.value = window.innerWidth;
  });
  effect(() => {
    document.documentElement.dataset["layout"] = layout.value;
  });
}

/** What the page begins with: it looks for a link or a kept project before it shows its entrance. */
import { computed, signal } from "@preact/signals";
import { files } from "../../state/project";
import { tourStep } from "../../state/tour";

/** "looking" for what was kept, "restoring" it, or "open". */
type Opening = "looking" | "restoring" | "open";

const reached = signal<Opening>("looking");

/** Nothing is open, and nothing is on its way. */
export const showsEntrance = computed(
  () => reached.value === "open" && files.value.length === 0 && tourStep.value === null,
);

/** Something is open, or on its way. */
export const showsWorkbench = computed(() => reached.value !== "looking" && !showsEntrance.value);

export function setOpening(next: Opening): void {
  reached.value = next;
}

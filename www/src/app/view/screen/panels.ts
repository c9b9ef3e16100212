/** What stands beside the view, one panel at a time: what the face tells of, or the project. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { mainResults } from "../../state/results";
import { tourStep } from "../../state/tour";
import { face, selection } from "../../state/viewState";
import { layout } from "./layout";

export type Panel = "main" | "project";

export const hasModel = computed(() => mainResults.value.facets !== null || mainResults.value.glb !== null);
/** Another occasion, and panels come by themselves again: the result has its model or none, the tour begins or ends. */
const occasion = computed(() => `${face.value === "method" || hasModel.value} ${tourStep.value === null}`);
/** What the person has opened or closed on this occasion. */
const chosen = signal<{ panel: Panel | null; occasion: string } | null>(null);

/** Whether there is room for a panel beside the view; else it lies over it. */
export const isRoomy = computed(() => layout.value === "tight" || layout.value === "wide");

export const shownPanel: ReadonlySignal<Panel | null> = computed(() => {
  if (chosen.value?.occasion === occasion.value) {
    return chosen.value.panel;
  }
  if (face.value === "result" && !hasModel.value) {
    return isRoomy.value ? "project" : null;
  }
  return isRoomy.value || face.value === "method" || selection.value !== null ? "main" : null;
});

/** Opens a panel, or closes what is open. */
export function openPanel(panel: Panel | null): void {
  chosen.value = { panel, occasion: occasion.value };
}

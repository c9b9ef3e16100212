/** An edge that is missing in the model, drawn by its two ends in one photograph; the core finds its line in the others. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import type { Vec2 } from "../../../shared/records";
import { scene } from "../../state/scene";
import { showTab } from "../../state/viewState";
import { showCorrecting } from "./drawn";
import { correct } from "./history";

/** Standard deviation of a click, pixels of the display. Assumption: of a hand with a mouse. */
const CLICK_PX = 2;

/** A place in a photograph, pixels of the view, each shown as `scale` pixels of the display. */
export interface Pixel {
  view: number;
  at: Vec2;
  scale: number;
}

const drawing = signal(false);
/** Whether clicks in the photographs are the ends of an edge. */
export const isDrawingEdge: ReadonlySignal<boolean> = drawing;

const start = signal<Pixel | null>(null);
/** The first end, once it is clicked. */
export const edgeStart: ReadonlySignal<Pixel | null> = start;

// An end in a photograph of another scene is none.
effect(() => {
  scene.value;
  drawing.value = false;
  start.value = null;
});

/** Begins an edge in the photographs, or leaves it. */
export function drawEdge(draws: boolean): void {
  drawing.value = draws;
  start.value = null;
  if (draws) {
    showCorrecting(true);
    showTab("images");
  }
}

/** Takes a clicked end; both ends lie in one photograph, so a click in another one begins anew. */
export async function takeEdgeEnd(view: number, at: Vec2, scale: number): Promise<void> {
  const first = start.value;
  const photograph = scene.peek()?.views[view]?.name;
  if (!drawing.value || photograph === undefined) {
    return;
  }
  if (first === null || first.view !== view) {
    start.value = { view, at, scale };
    return;
  }
  drawEdge(false);
  await correct({
    correction: "add_edge",
    photograph,
    pixels: [first.at, at],
    sigma_px: Number((CLICK_PX / Math.min(first.scale, scale)).toPrecision(2)),
  });
}

/** Points that were clicked in the 3D view, for facets and edges that are missing. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { Vec3 } from "../../../shared/records";
import { face } from "../../state/viewState";

const points = signal<readonly Vec3[]>([]);
/** Local frame, in the order of the clicks. */
export const drawn: ReadonlySignal<readonly Vec3[]> = points;

const correcting = signal(false);
/** Whether the model is being corrected: corners can be dragged, points drawn. */
export const isCorrecting: ReadonlySignal<boolean> = computed(
  () => correcting.value && face.value === "result",
);

export function showCorrecting(shows: boolean): void {
  correcting.value = shows;
  if (!shows) {
    forgetDrawn();
  }
}

export function forgetDrawn(): void {
  points.value = [];
}

/** A drawn point was dragged elsewhere. */
export function moveDrawn(index: number, to: Vec3): void {
  points.value = points.value.map((point, i) => (i === index ? to : point));
}

/** Takes a clicked point. */
export function takePoint(point: Vec3): void {
  points.value = [...points.value, point];
}

/** Points that were clicked in the 3D view, for facets and edges that are missing. */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { Vec3 } from "../../shared/records";
import { ask } from "../session/session";
import { announce } from "../state/notices";

const points = signal<readonly Vec3[]>([]);
/** Local frame, in the order of the clicks. */
export const drawn: ReadonlySignal<readonly Vec3[]> = points;

/** Whether the model is being corrected: corners can be dragged, points drawn. */
const correcting = signal(false);
export const isCorrecting: ReadonlySignal<boolean> = correcting;

export function showCorrecting(shows: boolean): void {
  correcting.value = shows;
  if (!shows) {
    forgetDrawn();
  }
}

export function forgetDrawn(): void {
  points.value = [];
  waiting = null;
}

/** A drawn point was dragged elsewhere. */
export function moveDrawn(index: number, to: Vec3): void {
  points.value = points.value.map((point, i) => (i === index ? to : point));
}

/** The first end of an edge that is being marked in a photograph. */
let waiting: Vec3 | null = null;

/** Takes a clicked point; of two through the camera of a view, the edge in space that the other views show. */
export async function takePoint(point: Vec3, view: number | null): Promise<void> {
  if (view === null) {
    points.value = [...points.value, point];
    return;
  }
  if (waiting === null) {
    waiting = point;
    announce("One end of the edge marked. Click the other one.");
    return;
  }
  const marked = new Float64Array([...waiting, ...point]);
  waiting = null;
  const found = await ask("edgeInSpace", view, marked);
  if (found == null) {
    announce("The other photographs show no such edge.");
    return;
  }
  points.value = [...points.value, found.p0, found.p1];
  announce("The edge was found in the other photographs.");
}

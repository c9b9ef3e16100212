/** What is looked at: the face, the tab, the view, the selection, and how the figures show them. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { Vec3 } from "../../shared/records";
import type { Selection, Standpoint } from "../../shared/selection";
import type { Tab } from "../../stages/list";
import { keep, kept } from "./keptChoice";

/** The model for those who want it, or how it comes about, stage by stage. */
export type Face = "result" | "method";

const present = {
  face: signal<Face>("result"),
  tab: signal<Tab>("images"),
  /** Of the result only the model and the photographs are shown. */
  resultTab: signal<Tab & ("images" | "model")>("images"),
  view: signal(0),
  selection: signal<Selection | null>(null),
  plane: signal(0),
  beforeGrowing: signal(false),
  followsSelection: signal(true),
  withRejected: signal(false),
  camera: signal<Standpoint | null>(null),
  aim: signal<readonly Vec3[] | null>(null),
};

export const face: ReadonlySignal<Face> = present.face;
export const tab: ReadonlySignal<Tab> = computed(() =>
  present.face.value === "result" ? present.resultTab.value : present.tab.value,
);
/** The view shown in the image tabs; -1: all of them side by side. */
export const shownView: ReadonlySignal<number> = present.view;
export const selection: ReadonlySignal<Selection | null> = present.selection;
/** Which cluster plane, or histogram, of the rectangles method is shown. */
export const shownPlane: ReadonlySignal<number> = present.plane;
/** Whether the 3D lines are shown as the segments alone gave them (B99 figures 5 and 7). */
export const beforeGrowing: ReadonlySignal<boolean> = present.beforeGrowing;
/** Whether the image tabs zoom to what is selected. */
export const followsSelection: ReadonlySignal<boolean> = present.followsSelection;
/** Whether the rejected lines of edgels are drawn too. */
export const withRejected: ReadonlySignal<boolean> = present.withRejected;

/** Where the person has put the 3D view's camera; null: where all is seen. */
export const camera: ReadonlySignal<Standpoint | null> = present.camera;

/** What the 3D view was last asked to look at, local frame. */
export const aim: ReadonlySignal<readonly Vec3[] | null> = present.aim;

export function aimAt(places: readonly Vec3[]): void {
  present.aim.value = places;
}

export function standAt(standpoint: Standpoint | null): void {
  present.camera.value = standpoint;
}

export function showTab(name: Tab): void {
  present.tab.value = name;
  if (name === "images" || name === "model") {
    present.resultTab.value = name;
  }
}

/** Whether somebody has opened a tab since the run began, which stays. */
let isChosen = false;

/** Turns to a tab that somebody opens. */
export function openTab(name: Tab): void {
  isChosen = true;
  showTab(name);
}

/** A run begins, and leads from tab to tab. */
export function beginLeading(): void {
  isChosen = false;
}

/** Turns to what a run has found, unless somebody has opened a tab meanwhile. */
export function leadTo(name: Tab): void {
  if (!isChosen) {
    showTab(name);
  }
}

const FACE_KEY = "ridgeline.face";

/** Turns to a face; it stays over visits. */
export function showFace(next: Face): void {
  present.face.value = next;
  keep(FACE_KEY, next);
}

/** Turns to the face of the last visit, unless another one is asked for. */
export function restoreFace(asked: Face | null): void {
  present.face.value = asked ?? (kept(FACE_KEY) === "method" ? "method" : "result");
}

export function showView(view: number): void {
  present.view.value = view;
}

export function select(picked: Selection | null): void {
  present.selection.value = picked;
}

export function showPlane(index: number): void {
  present.plane.value = index;
}

export function showBeforeGrowing(before: boolean): void {
  present.beforeGrowing.value = before;
}

export function zoomToSelection(zooms: boolean): void {
  present.followsSelection.value = zooms;
}

export function showRejected(shows: boolean): void {
  present.withRejected.value = shows;
}

/** What is looked at: the tab, the view, the selection, and how the figures show them. */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { Selection, Standpoint } from "../../shared/selection";
import type { Tab } from "../../stages/list";

const present = {
  tab: signal<Tab>("images"),
  view: signal(0),
  selection: signal<Selection | null>(null),
  plane: signal(0),
  beforeGrowing: signal(false),
  followsSelection: signal(true),
  withRejected: signal(false),
  camera: signal<Standpoint | null>(null),
};

export const tab: ReadonlySignal<Tab> = present.tab;
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

export function standAt(standpoint: Standpoint | null): void {
  present.camera.value = standpoint;
}

export function showTab(name: Tab): void {
  present.tab.value = name;
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

/** What the figures show of the selection beyond the results. */
import { type ReadonlySignal, signal } from "@preact/signals";
import type { WarpedPicture } from "../../shared/calls";
import type { Correspondence, SegmentMatching, SideTrace } from "../../shared/records";

/** What the figures show of the selected segment or side, and what the core answered about it. */
export interface SelectionDetail {
  /** The story of the selected segment. */
  story: SegmentMatching | null;
  /** The candidate that is compared with it, by its place in the story. */
  candidate: number;
  /** Where on the segment the point is, 0 to 1. */
  at: number;
  /** Whether the reader moved it. */
  isMoved: boolean;
  correspondence: Correspondence | null;
  /** The side of the selected line or half-plane, its Sim(theta), and the angle that is tried, radians. */
  side: SideTrace | null;
  theta: number;
  /** Whether the reader turned it. */
  isTurned: boolean;
  warped: WarpedPicture | null;
}

export const NO_DETAIL: SelectionDetail = {
  story: null,
  candidate: 0,
  at: 0.5,
  isMoved: false,
  correspondence: null,
  side: null,
  theta: 0,
  isTurned: false,
  warped: null,
};

const shown = signal<SelectionDetail>(NO_DETAIL);

export const selectionDetail: ReadonlySignal<SelectionDetail> = shown;

/** Another selection: nothing of the last one stays. */
export function beginDetail(first: Partial<SelectionDetail> = {}): void {
  shown.value = { ...NO_DETAIL, ...first };
}

export function changeDetail(part: Partial<SelectionDetail>): void {
  shown.value = { ...shown.peek(), ...part };
}

/** What a link says of the thing that it selects. */
export interface Resumed {
  thetaDeg: number | null;
  point: readonly [candidate: number, at: number] | null;
}

let resumed: Resumed = { thetaDeg: null, point: null };

/** The next selection is shown as a link says. */
export function resumeDetail(of: Resumed): void {
  resumed = of;
}

/** What the link said; once. */
export function takeResumed(): Resumed {
  const of = resumed;
  resumed = { thetaDeg: null, point: null };
  return of;
}

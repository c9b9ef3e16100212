/**
 * A figure: all that its components read, and what they can do. The page makes one of its state, an element that stands by itself
 * of its own; the components know neither, so a figure is written once.
 */
import type { WarpedPicture } from "../shared/calls";
import type { ParamTree } from "../shared/paramTree";
import type { Correspondence, SceneInfo, SegmentMatching, SideTrace } from "../shared/records";
import type { Selection } from "../shared/selection";
import type { Results } from "./list";

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

/** What a link says of the thing that it selects. */
export interface Resumed {
  thetaDeg: number | null;
  point: readonly [candidate: number, at: number] | null;
}

/** In the place of a view: all of them side by side. */
export const ALL_VIEWS = -1;

export interface Figure {
  scene: SceneInfo | null;
  /** The undistorted images, by view. */
  images: readonly ImageBitmap[];
  results: Results;
  params: ParamTree;
  selection: Selection | null;
  detail: SelectionDetail;
  /** The view that is shown, or `ALL_VIEWS`. */
  view: number;
  /** Which cluster plane, or histogram, of the rectangles method is shown. */
  plane: number;
  /** Whether it stands in a text that scrolls: the wheel is then the text's until a photograph has the focus. */
  inText: boolean;
  act: FigureActions;
}

export interface FigureActions {
  select(picked: Selection | null): void;
  /** Compares the selected segment with another candidate, or at another of its points. */
  compareAt(candidate: number, at: number): void;
  /** Turns the half-plane of the selected side to an angle, radians. */
  turnTo(theta: number): void;
  showView(view: number): void;
  showPlane(index: number): void;
  /** Shows a photograph by itself; null where there is no place for that. */
  openView: ((view: number) => void) | null;
}

/** A view's name, or its number where it has none. */
export function viewName({ scene }: Pick<Figure, "scene">, view: number): string {
  return scene?.views[view]?.name ?? `view ${view}`;
}

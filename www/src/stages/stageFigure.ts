/**
 * What is drawn and said of a stage, on the page and in figures of other pages: `<name>/figure.tsx`, gathered in `figures.ts`. It
 * knows nothing of the page's state.
 */
import type { ComponentType } from "preact";
import type { LegendEntry } from "../app/parts/Legend";
import type { Row } from "../app/results/takeAlong/rows";
import type { FigureText } from "../app/view/figures/AboutFigure";
import type { Overlay } from "../app/view/images/drawing";
import type { Selection } from "../shared/selection";
import type { Figure } from "./figure";
import type { Results } from "./list";

export type FigureView = ComponentType<{ figure: Figure }>;

export interface StageFigure extends FigureText {
  /** Its numbers as a table. */
  rows(figure: Figure): Row[];
  /** What is drawn over a photograph. */
  overlay?(view: number, figure: Figure, withRejected?: boolean): Overlay;
  /** What stands below the photographs or the space. */
  Lab?: FigureView;
  /** What the colours mean: an entry without anything in its colour would be looked for. */
  legend?(shown: Shown): readonly LegendEntry[];
  /** Its figures in other pages, by the name that `kind` has in HTML. */
  kinds?: Readonly<Record<string, StageKind>>;
}

/** What is shown, as far as a legend depends on it. */
export interface Shown {
  results: Results;
  beforeGrowing: boolean;
  withRejected: boolean;
}

export interface StageKind {
  View: FigureView;
  /** What is picked until a reader picks. */
  begin?(figure: Figure): Selection | null;
  /** The numbers behind it, where they are not those of its stage. */
  rows?(figure: Figure): Row[];
}

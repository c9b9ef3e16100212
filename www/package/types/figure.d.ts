/** `import "ridgeline/figure"` makes `<ridgeline-figure>` known. */

/** Where a figure is; null: as it shows itself first. */
export interface FigureState {
  /** What is selected: "line:12", "segment:0.44" (view first), "side:12.left", "halfplane:3", "facet:3" ... */
  select: string | null;
  /** Angle of the half-plane, degrees. */
  theta: number | null;
  /** The candidate that the segment is compared with, and where on the segment, 0 to 1. */
  point: readonly [candidate: number, at: number] | null;
  /** The view that is shown. */
  view: number | null;
  /** Which building or plane of W96 is shown. */
  plane: number | null;
}

export interface SceneFile {
  /** Path within the scene; folders are separated by slashes. */
  path: string;
  blob: Blob;
}

export type Row = Record<string, string | number | boolean | null>;

/** Attributes: kind, scene, base, explained, theme, select, theta, point, view, plane. */
export declare class RidgelineFigure extends HTMLElement {
  /** Where the figure is. Setting a part of it leaves the rest. */
  get state(): FigureState;
  set state(state: Partial<FigureState>);
  /** Files of a scene that has no address; null: the scene of the attribute. */
  get files(): readonly SceneFile[] | null;
  set files(files: readonly SceneFile[] | null);
  /** These throw before the event "ridgeline-ready". */
  /** What it shows: scene, results of the stages, selection, and what the core answered about it. */
  readonly shown: unknown;
  /** Asks the core about the scene; null where it cannot answer. */
  ask(call: "segmentStory" | "correspondence" | "side", ...of: (number | boolean)[]): Promise<unknown>;
  toSvg(): string;
  toPng(): Promise<Blob>;
  rows(): Row[];
  toCsv(): string;
  /** The paper that it is from, as BibTeX. */
  citation(): string;
  /** The address of this page that opens the figure as it is. */
  link(): string;
}

declare global {
  interface HTMLElementTagNameMap {
    "ridgeline-figure": RidgelineFigure;
  }
  interface HTMLElementEventMap {
    /** It is drawn. */
    "ridgeline-ready": CustomEvent<FigureState>;
    /** A reader, or the page, has changed it. */
    "ridgeline-state": CustomEvent<FigureState>;
    "ridgeline-failure": CustomEvent<{ message: string }>;
  }
}

/** The rows of the inspector, and the things that they lead on to. */
import type { Selection } from "../shared/selection";

/** A number of the picked thing, or other things that made it or that it made, to go on to. */
export type Row = readonly [label: string, value: string | readonly Related[], note?: string];

export interface Related {
  name: string;
  selection: Selection;
}

export const linkToLine = (index: number): Related => ({
  name: String(index),
  selection: { kind: "line", index },
});
export const linkToHalfPlane = (index: number): Related => ({
  name: String(index),
  selection: { kind: "halfplane", index },
});
export const linkToFacet = (index: number): Related => ({
  name: String(index),
  selection: { kind: "facet", index },
});
export const linkToRefinement = (index: number): Related => ({
  name: String(index),
  selection: { kind: "refinement", index },
});
export const linkToGroup = (index: number): Related => ({
  name: String(index),
  selection: { kind: "group", index },
});

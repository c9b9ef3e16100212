/** The rows of the inspector, and the things that they lead on to. */
import type { Selection } from "../../shared/selection";

/** A number of the picked thing, or other things that made it or that it made, to go on to. */
export type Row = readonly [label: string, value: string | readonly Related[], note?: string];

export interface Related {
  name: string;
  selection: Selection;
}

/** To the thing of this kind at an index. */
const linkTo =
  (kind: IndexedKind) =>
  (index: number): Related => ({ name: String(index), selection: { kind, index } });

export const linkToLine = linkTo("line");
export const linkToHalfPlane = linkTo("halfplane");
export const linkToFacet = linkTo("facet");
export const linkToRefinement = linkTo("refinement");
export const linkToGroup = linkTo("group");

type IndexedKind = "line" | "halfplane" | "facet" | "refinement" | "group";

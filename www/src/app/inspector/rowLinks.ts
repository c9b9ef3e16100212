/** The rows of the inspector, and the things that they lead on to. */
import type { Selection } from "../../shared/selection";

/** A number of the picked thing, things to go on to (they made it or it made them), or bars. */
export type Row = readonly [label: string, value: string | readonly Related[] | Bars, note?: string];

export interface Related {
  name: string;
  selection: Selection;
}

/** Amounts for it and against it, positive and negative. */
export interface Bars {
  bars: readonly Bar[];
}

export interface Bar {
  name: string;
  nats: number;
}

/** The indices of the items that pass. */
export function indicesOf<T>(items: readonly T[] | null | undefined, test: (item: T) => boolean): number[] {
  return (items ?? []).flatMap((item, i) => (test(item) ? [i] : []));
}

/** To the thing of this kind at an index. */
const linkTo =
  (kind: IndexedKind) =>
  (index: number): Related => ({ name: String(index), selection: { kind, index } });

export const linkToLine = linkTo("line");
export const linkToHalfPlane = linkTo("halfplane");
export const linkToFacet = linkTo("facet");
export const linkToRefinement = linkTo("refinement");
export const linkToDense = linkTo("dense");
export const linkToCoplanar = linkTo("coplanar");
export const linkToCorner = linkTo("corner");
export const linkToGroup = linkTo("group");

type IndexedKind = "line" | "halfplane" | "facet" | "refinement" | "dense" | "coplanar" | "corner" | "group";

/** The tour: straight edges. */

import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { lengthOf, segmentAt } from "../../shared/flatArrays";
import { numberOf } from "../../shared/selection";
import type { Results } from "../list";
import { ofPicked, type StageStep } from "../tourStep";

const LONG_PX = 60;

export default [
  {
    title: "Straight edges",
    text: "Everything begins with edgels linked into straight segments. A roof edge is rarely found whole in every view, and the longest segments need not be roofs.",
    question: `Pick a segment at the edge of a roof, longer than ${LONG_PX} pixels.`,
    ...ofPicked(pickedSegment, {
      answer: ({ length, facet }) =>
        `${length.toFixed(0)} px, at a side of facet ${numberOf(facet ?? 0)} of the finished model. One photograph alone cannot tell it from a kerb: that takes the other views.`,
      hint: ({ length, facet }) =>
        facet === null
          ? `${length.toFixed(0)} px long, but no facet of the model has it as a side: kerbs, paths and shadows are straight, too.`
          : `It is at a side of facet ${numberOf(facet)}, but ${length.toFixed(0)} px long: look for a longer one.`,
      isFound: ({ length, facet }) => facet !== null && length > LONG_PX,
    }),
  },
] satisfies readonly StageStep[];

/** Of the picked segment; null where none is picked. */
function pickedSegment() {
  const picked = selection.value;
  return picked?.kind === "segment"
    ? {
        length: segmentLength(results.value, picked.view, picked.index),
        facet: facetOfSegment(results.value, picked.view, picked.index),
      }
    : null;
}

/** Length of a segment in its photograph, pixels. */
export function segmentLength({ segments }: Pick<Results, "segments">, view: number, index: number): number {
  return lengthOf(segmentAt(segments[view], index));
}

/** The facet that a segment shows a side of; null where there is none. */
export function facetOfSegment(
  { records, facets }: Pick<Results, "records" | "facets">,
  view: number,
  segment: number,
): number | null {
  const line = records.findIndex(({ supports }) =>
    supports.some((one) => one.view === view && one.segments.includes(segment)),
  );
  const facet = facets?.findIndex(({ lines }) => lines?.includes(line)) ?? -1;
  return line < 0 || facet < 0 ? null : facet;
}

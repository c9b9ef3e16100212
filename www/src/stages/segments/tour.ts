/** The tour: straight edges. */
import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { numberOf } from "../../shared/selection";
import type { Results } from "../list";
import type { StageStep } from "../tourStep";

const LONG_PX = 60;

export default [
  {
    title: "Straight edges",
    text: "Everything begins with edgels linked into straight segments. A roof edge is rarely found whole in every view, and the longest segments need not be roofs.",
    question: `Pick a segment at the edge of a roof, longer than ${LONG_PX} pixels.`,
    answer: () => {
      const { length, facet } = pickedSegment();
      return `${length.toFixed(0)} px, at a side of facet ${numberOf(facet ?? 0)} of the finished model. One photograph alone cannot tell it from a kerb: that takes the other views.`;
    },
    hint: () => {
      const { length, facet } = pickedSegment();
      if (length === 0) {
        return null;
      }
      return facet === null
        ? `${length.toFixed(0)} px long, but no facet of the model has it as a side: kerbs, paths and shadows are straight, too.`
        : `It is at a side of facet ${numberOf(facet)}, but ${length.toFixed(0)} px long: look for a longer one.`;
    },
    isFound: () => {
      const { length, facet } = pickedSegment();
      return facet !== null && length > LONG_PX;
    },
  },
] satisfies readonly StageStep[];

/** Of the picked segment; no length where none is picked. */
function pickedSegment(): { length: number; facet: number | null } {
  const picked = selection.value;
  return picked?.kind === "segment"
    ? {
        length: segmentLength(results.value, picked.view, picked.index),
        facet: facetOfSegment(results.value, picked.view, picked.index),
      }
    : { length: 0, facet: null };
}

/** Length of a segment in its photograph, pixels. */
export function segmentLength({ segments }: Pick<Results, "segments">, view: number, index: number): number {
  const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = segments[view]?.subarray(4 * index, 4 * index + 4) ?? [];
  return Math.hypot(x1 - x0, y1 - y0);
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

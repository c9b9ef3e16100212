/** How the flat arrays of the core are laid out: numbers per entry, and what their codes stand for. */

export const SEGMENT_STRIDE = 4;
export const SUPPORT_STRIDE = 6;
export const LINE_STRIDE = 6;
/** line, then p0 and p1 of a stretch. */
export const STRETCH_STRIDE = 7;
/** x0, y0, x1, y1, reason. */
export const REJECTED_STRIDE = 5;

/** How a stretch of a matched line came about, as `matchedSegments` numbers it. */
export const SUPPORT_KINDS = ["matched", "merged", "grown"] as const;

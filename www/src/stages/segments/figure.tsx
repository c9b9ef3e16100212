/** The segments of each view. */

import type { Row } from "../../app/results/takeAlong/rows";
import type { Overlay } from "../../app/view/images/drawing";
import { PickedImage } from "../../app/view/images/ImageRow";
import { type Figure, viewName } from "../figure";
import type { StageFigure } from "../stageFigure";

export default {
  title: "Line segments",
  source: "B99 3.2",
  text: "[[edgel|Edgels]] with sub-pixel positions are linked into chains, broken where the tangent turns, and fitted by orthogonal regression: the line l leaves the smallest distances to its edgels x. Red: lines that were rejected, as part of a curve or as texture.",
  equation: ["vec l ^T vec x = 0"],
  hint: "Pick a segment for its length and direction; before matching that is all we know. Rejected lines say why.",

  rows: (figure) =>
    figure.results.segments.flatMap((own, view) =>
      Array.from({ length: own.length / 4 }, (_, segment): Row => {
        const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = own.subarray(4 * segment, 4 * segment + 4);
        return { view: viewName(figure, view), segment, x0, y0, x1, y1 };
      }),
    ),
  overlay,
  legend: ({ withRejected }) => [
    ["unmatched", "segment"],
    ...(withRejected ? [["rejected", "rejected"] as const] : []),
  ],
  kinds: { segments: { View: ({ figure }) => <PickedImage figure={figure} overlay={overlay} /> } },
} satisfies StageFigure;

function overlay(view: number, { results }: Figure, withRejected = false): Overlay {
  const { segments, rejected } = results;
  return {
    segments: segments[view] ?? null,
    supports: null,
    rejected: withRejected ? (rejected[view] ?? null) : null,
  };
}

/** Segments with their candidates in other views, and what was matched. */

import type { Row } from "../../app/results/takeAlong/rows";
import type { Overlay } from "../../app/view/images/drawing";
import { ImageRow } from "../../app/view/images/ImageRow";
import { lengthOf, segmentAt } from "../../shared/flatArrays";
import type { Selection } from "../../shared/selection";
import { type Figure, viewName } from "../figure";
import type { StageFigure } from "../stageFigure";
import { PointLab } from "./PointLab";

export default {
  title: "Matching over views",
  source: "B99 3.1 to 3.4, figures 1 to 5 and 7",
  text: "The end points of a [[segment]] bound an [[epipolar-beam]] in every other view. [[candidate|Candidates]] in it are compared point by point: x′ is where the [[epipolar-line]] of x meets the candidate l′. A pair predicts the line in third views, by their [[trifocal-tensor|trifocal tensors]]; there a segment or, without one, a higher correlation must confirm it.",
  equation: ["vec x′ = vec l′ × ( F vec x )"],
  hint: "Pick a segment; then choose a candidate and drag the point along it.",

  rows: candidateRows,
  overlay,
  Lab: PointLab,
  legend: () => [
    ["unmatched", "unmatched"],
    ["matched", "matched"],
    ["merged", "merged"],
    ["grown", "grown"],
  ],
  kinds: {
    // B99 figures 1, 2 and 4: a segment, and its beam and candidates in the view of the one it is compared with.
    "epipolar-beam": { View: overViews((figure) => viewsOfSegment(figure).slice(0, 2)), begin: longSegment },
    // B99 figure 3: the pair predicts the line in a third view.
    "point-transfer": { View: overViews(viewsOfSegment), begin: longSegment },
    "correlation-windows": { View: PointLab, begin: longSegment, rows: windowRows },
  },
} satisfies StageFigure;

function overlay(view: number, { results: { segments, supports } }: Figure): Overlay {
  return { segments: segments[view] ?? null, supports: supports[view] ?? null, segmentsFirst: true };
}

/** Candidates of the picked segment, and where each predicts it in third views. */
function candidateRows(figure: Figure): Row[] {
  const { story } = figure.detail;
  return (story?.candidates ?? []).flatMap(({ view, segment, score, line, predictions }, candidate) => {
    const own: Row = { candidate, view: viewName(figure, view), segment, score, match: line };
    const thirds = predictions.map((one): Row => {
      const [x0, y0] = one.segment.p0;
      const [x1, y1] = one.segment.p1;
      const predicted = { third_view: viewName(figure, one.view), x0, y0, x1, y1 };
      return { ...own, ...predicted, distance_px: one.distance_px, verified_by: one.verified };
    });
    const none = { third_view: null, x0: null, y0: null, x1: null, y1: null };
    return thirds.length > 0 ? thirds : [{ ...own, ...none, distance_px: null, verified_by: null }];
  });
}

/** Both correlation windows, pixel by pixel. */
function windowRows({ detail: { correspondence } }: Figure): Row[] {
  const { window = [], other_window: other = [] } = correspondence ?? {};
  const side = Math.round(Math.sqrt(window.length));
  return window.map((value, i) => ({
    column: i % side,
    row: Math.floor(i / side),
    value,
    other_value: other[i] ?? null,
  }));
}

function overViews(viewsOf: (figure: Figure) => readonly number[]) {
  return ({ figure }: { figure: Figure }) => (
    <div class="over-lab">
      <ImageRow figure={figure} overlay={overlay} views={viewsOf(figure)} follows />
      <PointLab figure={figure} />
    </div>
  );
}

/** The segment's own view, that of the compared candidate, and that of its first prediction. */
function viewsOfSegment({ selection, detail: { story, candidate } }: Figure): [number, number, number] {
  const own = selection?.kind === "segment" ? selection.view : 0;
  const compared = story?.candidates[candidate];
  const other = compared?.view ?? (own === 0 ? 1 : 0);
  const predicted = compared?.predictions.find(({ verified }) => verified !== null);
  const third = [0, 1, 2].find((view) => view !== own && view !== other) ?? 0;
  return [own, other, predicted?.view ?? third];
}

/** Of the first view, pixels over its width: a longer segment is rather a kerb than the side of a roof. */
const LONGEST = 0.25;

/** The longest segment of the first view that is part of a match, of those that may be sides of roofs. */
function longSegment({ scene, results: { supports, segments } }: Figure): Selection | null {
  const longest = LONGEST * (scene?.views[0]?.width ?? Number.POSITIVE_INFINITY);
  const [own, matched] = [segments[0], supports[0]];
  let best = { index: 0, length: 0 };
  for (let index = 0; ; index += 1) {
    const ends = segmentAt(own, index);
    if (ends === null) {
      return index === 0 ? null : { kind: "segment", view: 0, index: best.index };
    }
    const length = lengthOf(ends);
    const isMatched = matched !== undefined && isAmong(matched, ends[0]);
    if (isMatched && length > best.length && length <= longest) {
      best = { index, length };
    }
  }
}

/** Whether a stretch that was matched begins or ends at a point. */
function isAmong(stretches: Float32Array, [x, y]: readonly [number, number]): boolean {
  for (let at = 0; at + 6 <= stretches.length; at += 6) {
    for (const end of [at, at + 2]) {
      if (Math.abs((stretches[end] as number) - x) + Math.abs((stretches[end + 1] as number) - y) < 2) {
        return true;
      }
    }
  }
  return false;
}

/** A straight segment of a view (B99 3.2), and what matching made of it (B99 3.1 to 3.4). */
import { outcomeWords } from "../../app/parts/reasonText";
import { SEGMENT_STRIDE } from "../../shared/flatArrays";
import { PALETTE } from "../../shared/palette";
import type { Vec2, Vec3, ViewInfo } from "../../shared/records";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { CHOSEN, diamond, endsIn, type Mark, SELECTED_PX, THIN_PX } from "../parts/marks";
import { allOf, degreesText, links, type Row } from "../parts/rows";
import { linesShape } from "../parts/shapes";

export default {
  title: "Segment",
  rows({ view, index }, { results, detail: { story } }) {
    const [p, q] = endsIn(results.segments[view], index, SEGMENT_STRIDE);
    return p === undefined || q === undefined
      ? []
      : [
          ...stretchRows(p, q),
          ["Direction", `${degreesText(Math.atan2(q[1] - p[1], q[0] - p[0]))} (y down)`],
          story && ["Outcome", outcomeWords(story.outcome)],
          story && ["Candidates", String(story.candidates.length)],
          results.lines && links("3D line", "line", lineOfSegment(view, index, results)),
        ];
  },
  siblings(picked, about) {
    const view = picked?.view ?? Math.max(0, about.view);
    const count = (about.results.segments[view]?.length ?? 0) / SEGMENT_STRIDE;
    return allOf(count, (index) => ({ kind: "segment", view, index }));
  },
  // A segment is in no place of space, but its line is.
  shapes: (picked, results) => linesShape(linesOfSegment(picked, results), results),
  /** In its own view the segment; in others its beam, its candidates with their scores, and where it should be. */
  marks({ view: own, index }, { view, info, results, detail: { story, candidate, correspondence } }) {
    const marks: Mark[] = [];
    const segment = (of: number, i: number) => endsIn(results.segments[of], i, SEGMENT_STRIDE);
    const compared = story?.candidates[candidate];
    if (view === own) {
      marks.push({ points: segment(own, index), ...CHOSEN });
      if (correspondence !== null) {
        marks.push(point(correspondence.x, "x"));
      }
      return marks;
    }
    for (const beam of story?.beams.filter((b) => b.view === view) ?? []) {
      marks.push({ points: beam.corners, closed: true, colour: PALETTE.beam, width: THIN_PX, fill: 0.16 });
    }
    story?.candidates.forEach((one, i) => {
      if (one.view === view) {
        const isCompared = i === candidate;
        marks.push({
          points: segment(view, one.segment),
          colour: isCompared ? PALETTE.selected : one.line === null ? PALETTE.unmatched : PALETTE.matched,
          width: isCompared ? SELECTED_PX : 2.25,
          label: one.score.toFixed(2),
        });
      }
    });
    for (const prediction of compared?.predictions.filter((p) => p.view === view) ?? []) {
      marks.push({
        points: [prediction.segment.p0, prediction.segment.p1],
        colour: PALETTE.grown,
        width: 2,
        dashed: true,
        labelSide: "below",
        label: prediction.distance_px === null ? "predicted" : `${prediction.distance_px.toFixed(2)} px`,
      });
      if (prediction.verified !== null) {
        marks.push({ points: segment(view, prediction.verified), colour: PALETTE.selected, width: 2.5 });
      }
    }
    if (correspondence !== null && compared?.view === view) {
      marks.push(epipolarMark(correspondence.epipolar, info), point(correspondence.other, "x′"));
    }
    return marks;
  },
  lines: linesOfSegment,
  question: ({ view, index }, { matching }) => matching && { about: "segment", view, index },
} satisfies Kind<"segment">;

/** Length and ends of a stretch of a view. */
export function stretchRows([x0, y0]: Vec2, [x1, y1]: Vec2): Row[] {
  return [
    ["Length", `${Math.hypot(x1 - x0, y1 - y0).toFixed(1)} px`],
    ["Start", `${x0.toFixed(2)}, ${y0.toFixed(2)} px`],
    ["End", `${x1.toFixed(2)}, ${y1.toFixed(2)} px`],
  ];
}

function linesOfSegment({ view, index }: { view: number; index: number }, results: Results): number[] {
  return results.matching === null ? [] : lineOfSegment(view, index, results);
}

/** The 3D line that a segment supports, if any. */
function lineOfSegment(view: number, segment: number, { records }: Results): number[] {
  const line = records.findIndex(({ supports }) =>
    supports.some((support) => support.view === view && support.segments.includes(segment)),
  );
  return line < 0 ? [] : [line];
}

/** The part of an image line that lies in the image. */
function epipolarMark([a, b, c]: Vec3, { width, height }: ViewInfo): Mark {
  const points: Vec2[] =
    Math.abs(b) > Math.abs(a)
      ? [
          [0, -c / b],
          [width, -(a * width + c) / b],
        ]
      : [
          [-c / a, 0],
          [-(b * height + c) / a, height],
        ];
  return { points, colour: PALETTE.beam, width: 1.25, dashed: true, label: "F x", labelSide: "left" };
}

function point(at: Vec2, label: string): Mark {
  const points = diamond(at, 2.5);
  return { points, closed: true, colour: PALETTE.rejected, width: 2, fill: 0.5, label, labelSide: "left" };
}

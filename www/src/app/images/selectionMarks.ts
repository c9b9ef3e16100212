/**
 * What a selection looks like in an image: polylines in pixels. Things in space are projected with the view's own
 * matrix, as the viewer's graphics card does; everything else is drawn as the core gave it.
 */

import { REJECTED_STRIDE, SEGMENT_STRIDE } from "../../shared/flatArrays";
import { PALETTE } from "../../shared/palette";
import type { Vec2, Vec3, ViewInfo } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import type { Figure, SelectionDetail } from "../../stages/figure";
import type { Results } from "../../stages/list";
import { type Shape, shapesOf } from "../selection/selectionShapes";
import { windowOf } from "./pairWindow";

/** A polyline over an image, pixels. */
export interface Mark {
  points: readonly Vec2[];
  closed?: boolean;
  colour: string;
  /** CSS pixels. */
  width: number;
  dashed?: boolean;
  /** Opacity of the area inside. */
  fill?: number;
  label?: string;
  /**
   * Above the right end, below it, or above the left one: predictions are below the candidates that they meet, points left of the
   * lines through them.
   */
  labelSide?: "left" | "right" | "below";
}

const SELECTED_PX = 3.5;
const THIN_PX = 1.5;

/** The image of a point of the local frame; null behind the camera. */
export function project({ projection: p }: Pick<ViewInfo, "projection">, [x, y, z]: Vec3): Vec2 | null {
  const at = (row: number) =>
    (p[4 * row] as number) * x +
    (p[4 * row + 1] as number) * y +
    (p[4 * row + 2] as number) * z +
    (p[4 * row + 3] as number);
  const depth = at(2);
  return depth > 0 ? [at(0) / depth, at(1) / depth] : null;
}

/** All that the present selection marks in a view. */
export function marksOf(
  picked: Selection | null,
  view: number,
  { scene, results, detail }: Pick<Figure, "scene" | "results" | "detail">,
): Mark[] {
  const info = scene?.views[view];
  if (picked === null || info === undefined) {
    return [];
  }
  switch (picked.kind) {
    case "segment":
      return segmentMarks(picked.view, picked.index, info, view, results, detail);
    case "rejectedSegment":
      return picked.view === view
        ? [{ points: ends(results.rejected[view], picked.index, REJECTED_STRIDE), ...CHOSEN }]
        : [];
    case "region":
      return picked.view === view
        ? (results.regions[view]?.regions[picked.index]?.rings ?? []).map((ring) => ({
            points: ring,
            ...AREA,
          }))
        : [];
    default: {
      const shapes = shapesOf(picked, results);
      // Of a building the outlines matter, not the areas.
      const style = (role: Shape["role"]) =>
        role === "area" && picked.kind === "refinement" ? OUTLINE : STYLES[role];
      return [
        ...(picked.kind === "pair" ? windowMarks(info, view, picked.index, results) : []),
        ...shapes.flatMap(({ points, role }) => seenFrom(info, points, style(role))),
        ...warpedMarks(view, detail),
      ];
    }
  }
}

/** The window of a pair of lines and what crosses it in this view (W96 figure 10). */
function windowMarks(info: ViewInfo, view: number, index: number, results: Results): Mark[] {
  const pair = results.rectangles?.pairs[index];
  const found = pair === undefined ? null : windowOf(pair, results);
  return found === null
    ? []
    : [
        ...seenFrom(info, found.outline, { colour: PALETTE.beam, width: 1, closed: true, fill: 0.1 }),
        ...found.crossings
          .filter((one) => one.view === view)
          .flatMap(({ ends }) => seenFrom(info, ends, { colour: PALETTE.grown, width: 2 })),
      ];
}

/** A polyline of the local frame in a view; none where a part lies behind the camera. */
function seenFrom(info: ViewInfo, points: readonly Vec3[], style: Omit<Mark, "points">): Mark[] {
  const seen = points.map((point) => project(info, point));
  return seen.every((p) => p !== null) ? [{ points: seen as Vec2[], ...style }] : [];
}

const CHOSEN: Omit<Mark, "points"> = { colour: PALETTE.selected, width: SELECTED_PX };
const AREA: Omit<Mark, "points"> = { ...CHOSEN, width: SELECTED_PX - 1, closed: true, fill: 0.14 };
const OUTLINE: Omit<Mark, "points"> = { ...CHOSEN, width: THIN_PX, closed: true };
const STYLES: Record<Shape["role"], Omit<Mark, "points">> = {
  line: CHOSEN,
  area: AREA,
  before: { ...OUTLINE, colour: PALETTE.grown },
};

/** The end points of a segment in a list of them; none where it has fewer. */
function ends(data: Float32Array | undefined, index: number, stride: number): Vec2[] {
  const [x0, y0, x1, y1] = data?.subarray(index * stride, index * stride + 4) ?? [];
  return x0 === undefined || y0 === undefined || x1 === undefined || y1 === undefined
    ? []
    : [
        [x0, y0],
        [x1, y1],
      ];
}

/** In its own view the segment; in others its beam, its candidates with their scores, and where it should be. */
function segmentMarks(
  own: number,
  index: number,
  info: ViewInfo,
  view: number,
  { segments }: Results,
  { story, candidate, correspondence }: SelectionDetail,
): Mark[] {
  const marks: Mark[] = [];
  const segment = (of: number, i: number) => ends(segments[of], i, SEGMENT_STRIDE);
  const compared = story?.candidates[candidate];
  if (view === own) {
    marks.push({ points: segment(own, index), ...CHOSEN });
    if (correspondence !== null) {
      marks.push(...point(correspondence.x, "x"));
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
    marks.push(...epipolarMark(correspondence.epipolar, info), ...point(correspondence.other, "x′"));
  }
  return marks;
}

/** The part of an image line that lies in the image. */
function epipolarMark([a, b, c]: Vec3, { width, height }: ViewInfo): Mark[] {
  const ends: Vec2[] =
    Math.abs(b) > Math.abs(a)
      ? [
          [0, -c / b],
          [width, -(a * width + c) / b],
        ]
      : [
          [-c / a, 0],
          [-(b * height + c) / a, height],
        ];
  return [{ points: ends, colour: PALETTE.beam, width: 1.25, dashed: true, label: "F x", labelSide: "left" }];
}

/** Where the warped picture of a side lies in a view. */
function warpedMarks(view: number, { warped }: SelectionDetail): Mark[] {
  const own = warped?.about.views.find((one) => one.view === view);
  return own?.outline == null
    ? []
    : [{ points: own.outline, closed: true, colour: PALETTE.halfPlane, width: 2, fill: 0.12 }];
}

function point([x, y]: Vec2, label: string): Mark[] {
  const r = 2.5;
  return [
    {
      points: [
        [x - r, y],
        [x, y - r],
        [x + r, y],
        [x, y + r],
      ],
      closed: true,
      colour: PALETTE.rejected,
      width: 2,
      fill: 0.5,
      label,
      labelSide: "left",
    },
  ];
}

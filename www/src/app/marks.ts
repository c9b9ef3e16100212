/**
 * What a selection looks like in an image: polylines in pixels. Things in space are projected with the view's own
 * matrix, as the viewer's graphics card does; everything else is drawn as the core gave it.
 */
import { PALETTE } from "../shared/palette";
import { type HalfPlane, LINE_STRIDE, SEGMENT_STRIDE, type Vec3, type ViewInfo } from "../shared/results";
import type { Selection } from "../shared/selection";
import type { Segment3, Vec2 } from "../shared/traces";
import { fanCorners } from "../viewer/fans";
import { outlinesOf } from "../viewer/refinement";
import { type Pointing, pointing, type Results, results, scene } from "./state";

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
  /** On which side of the mark; points have the left one, so that lines through them keep theirs. */
  labelSide?: "left" | "right";
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
export function marksOf(picked: Selection | null, view: number): Mark[] {
  const info = scene.value?.views[view];
  if (picked === null || info === undefined) {
    return [];
  }
  const inView = (points: readonly Vec3[]) => points.map((point) => project(info, point));
  const shape = (points: readonly Vec3[], style: Omit<Mark, "points">): Mark[] => {
    const seen = inView(points);
    return seen.every((p) => p !== null) ? [{ points: seen as Vec2[], ...style }] : [];
  };
  switch (picked.kind) {
    case "segment":
      return segmentMarks(picked.view, picked.index, view, results.value, pointing.value);
    case "line":
      return [...shape(lineEnds(picked.index), chosen()), ...warpedMarks(view, pointing.value)];
    case "side":
      return [...shape(lineEnds(picked.line), chosen()), ...warpedMarks(view, pointing.value)];
    case "halfplane": {
      const halfPlane = results.value.halfPlanes?.[picked.index];
      return halfPlane === undefined
        ? []
        : [...shape(fanOf(halfPlane), area()), ...warpedMarks(view, pointing.value)];
    }
    case "group":
      return groupLines(picked.index).flatMap((line) => shape(lineEnds(line), chosen()));
    case "facet":
      return facetRings(picked.index).flatMap((ring) => shape(ring, area()));
    case "surface":
      return picked.facet === null ? [] : facetRings(picked.facet).flatMap((ring) => shape(ring, area()));
    case "refinement":
      return [
        ...ringsBefore(picked.index).flatMap((ring) =>
          shape(ring, { colour: PALETTE.grown, width: THIN_PX, closed: true }),
        ),
        ...refinedFacets(picked.index)
          .flatMap(facetRings)
          .flatMap((ring) => shape(ring, { ...chosen(), width: THIN_PX, closed: true })),
      ];
    case "relation":
      return relationOf(picked.building, picked.index).flatMap(({ p0, p1 }) => shape([p0, p1], chosen()));
    case "region":
      return picked.view === view
        ? (results.value.regions[view]?.regions[picked.index]?.rings ?? []).map((ring) => ({
            points: ring,
            ...area(),
          }))
        : [];
    case "pair": {
      const pair = results.value.rectangles?.pairs[picked.index];
      return pair === undefined ? [] : pair.lines.flatMap((line) => shape(lineEnds(line), chosen()));
    }
    case "view":
      return [];
  }
}

/** The end points of a 3D line; none where there is no such line. */
export function lineEnds(index: number): Vec3[] {
  const lines = results.value.lines;
  const at = index * LINE_STRIDE;
  if (lines === null || at + LINE_STRIDE > lines.length) {
    return [];
  }
  const n = [...lines.subarray(at, at + LINE_STRIDE)] as [number, number, number, number, number, number];
  return [
    [n[0], n[1], n[2]],
    [n[3], n[4], n[5]],
  ];
}

/** The 3D lines that belong to a selection. */
export function linesOfSelection(picked: Selection | null): readonly number[] {
  const { halfPlanes, facets, rectangles, matching } = results.peek();
  switch (picked?.kind) {
    case "line":
      return [picked.index];
    case "side":
      return [picked.line];
    case "halfplane":
      return [halfPlanes?.[picked.index]?.line ?? -1].filter((line) => line >= 0);
    case "group":
      return groupLines(picked.index);
    case "facet":
      return facets?.[picked.index]?.lines ?? [];
    case "surface":
      return picked.facet === null ? [] : (facets?.[picked.facet]?.lines ?? []);
    case "pair":
      return rectangles?.pairs[picked.index]?.lines ?? [];
    case "segment":
      return matching === null ? [] : lineOfSegment(picked.view, picked.index);
    default:
      return [];
  }
}

/** The 3D line that a segment supports, if any. */
export function lineOfSegment(view: number, segment: number): number[] {
  const line = results
    .peek()
    .records.findIndex(({ supports }) =>
      supports.some((support) => support.view === view && support.segments.includes(segment)),
    );
  return line < 0 ? [] : [line];
}

/** The 3D lines of a plane group, each once. */
export function groupLines(index: number): number[] {
  const members = results.value.grouping?.groups[index]?.members ?? [];
  return [...new Set(members.map(({ line }) => line))];
}

/** The facets of the model that refinement made of a building. */
export function refinedFacets(building: number): number[] {
  const before = results.value.refinement?.before;
  return (before?.sources ?? []).flatMap((source, facet) =>
    before?.facets[source]?.building === building ? [facet] : [],
  );
}

function ringsBefore(building: number): readonly (readonly Vec3[])[] {
  const { refinement } = results.value;
  return refinement === null ? [] : outlinesOf(refinement, building);
}

function relationOf(building: number, index: number): readonly Segment3[] {
  return results.value.refinement?.trace.buildings[building]?.relations[index]?.sides ?? [];
}

function facetRings(index: number): readonly (readonly Vec3[])[] {
  const facet = results.value.facets?.[index];
  return facet === undefined ? [] : [facet.outer, ...facet.holes];
}

function fanOf(halfPlane: HalfPlane): Vec3[] {
  const { lines } = results.value;
  return lines === null ? [] : fanCorners(halfPlane, lines).map(({ x, y, z }) => [x, y, z]);
}

const chosen = (): Omit<Mark, "points"> => ({ colour: PALETTE.selected, width: SELECTED_PX });
const area = (): Omit<Mark, "points"> => ({
  colour: PALETTE.selected,
  width: SELECTED_PX - 1,
  closed: true,
  fill: 0.14,
});

/** In its own view the segment; in others its beam, its candidates with their scores, and where it should be. */
function segmentMarks(
  own: number,
  index: number,
  view: number,
  { segments }: Results,
  { story, candidate, correspondence }: Pointing,
): Mark[] {
  const marks: Mark[] = [];
  const segment = (of: number, i: number): Vec2[] => {
    const data = segments[of]?.subarray(i * SEGMENT_STRIDE, (i + 1) * SEGMENT_STRIDE);
    return data?.length === SEGMENT_STRIDE
      ? [
          [data[0] as number, data[1] as number],
          [data[2] as number, data[3] as number],
        ]
      : [];
  };
  const compared = story?.candidates[candidate];
  if (view === own) {
    marks.push({ points: segment(own, index), ...chosen() });
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
      label: prediction.distance_px === null ? "predicted" : `${prediction.distance_px.toFixed(2)} px`,
    });
    if (prediction.verified !== null) {
      marks.push({ points: segment(view, prediction.verified), colour: PALETTE.selected, width: 2.5 });
    }
  }
  if (correspondence !== null && compared?.view === view) {
    marks.push(...epipolarMark(correspondence.epipolar, view), ...point(correspondence.other, "x′"));
  }
  return marks;
}

/** The part of an image line that lies in the image. */
function epipolarMark([a, b, c]: Vec3, view: number): Mark[] {
  const info = scene.value?.views[view];
  if (info === undefined) {
    return [];
  }
  const { width, height } = info;
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
  return [{ points: ends, colour: PALETTE.beam, width: 1.25, dashed: true, label: "F x" }];
}

/** Where the warped picture of a side lies in a view. */
function warpedMarks(view: number, { warped }: Pointing): Mark[] {
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

/**
 * What the core tells of how its results came about: the traces that the live figures draw. Units as in
 * `results.ts`; indices refer to views, segments of their view, 3D lines, half-planes, facets.
 */
import type { Facet, Plane, SupportKind, Vec3 } from "./results";

export type Vec2 = readonly [number, number];

export interface Segment2 {
  p0: Vec2;
  p1: Vec2;
}

export interface Segment3 {
  p0: Vec3;
  p1: Vec3;
}

export type SideName = "left" | "right";

/** Number and total length in the images of some segments. */
export interface StepCount {
  number: number;
  length_px: number;
}

export interface MatchRecord {
  z_range_m: Vec2 | null;
  view_pairs: Vec2[];
  candidates: number;
  pairs: number;
  triples_before: number;
  triples_after: number;
  detected: StepCount;
  matched: StepCount;
  merged: StepCount;
  grown: StepCount;
}

export type SegmentOutcome =
  | { fate: "matched"; line: number }
  | { fate: "no_candidate" }
  | { fate: "below_threshold"; best: number }
  | { fate: "not_verified"; reason: string }
  | { fate: "left_out"; line: number }
  | { fate: "lost_to"; line: number };

export interface Prediction {
  view: number;
  segment: Segment2;
  verified: number | null;
  distance_px: number | null;
}

export interface Candidate {
  view: number;
  segment: number;
  score: number;
  line: number | null;
  predictions: Prediction[];
}

export interface SegmentStory {
  outcome: SegmentOutcome | null;
  beams: { view: number; corners: Vec2[] }[];
  candidates: Candidate[];
}

export interface Correspondence {
  x: Vec2;
  /** l with l . (x, y, 1) a distance in pixels. */
  epipolar: Vec3;
  other: Vec2;
  /** What is compared: grey values or warmth, red less blue. */
  channel: "grey" | "warmth";
  window: number[];
  other_window: number[];
  correlation: number | null;
}

/** xx, xy, xz, yy, yz, zz of a symmetric matrix, m². */
export type Covariance = readonly [number, number, number, number, number, number];

/** How a 3D line was found: from segments, or with the model (B99 4.2, 4.3). */
export type LineOrigin = "matched" | "clustered" | "intersection" | "border";

/** Why the finished model contradicts a line, and leaves it out. */
export type Contradiction = "hidden" | "underground" | "afloat" | "too_few_views" | "repeated";

export interface LineRecord {
  origin: LineOrigin;
  refuted: Contradiction | null;
  /** The larger semi-axis of both ends' ellipses across the line, one standard deviation. */
  sigma_m: number;
  /** Of the start and of the end point. */
  covariance: readonly [Covariance, Covariance];
  supports: { view: number; segments: number[]; score: number; kind: SupportKind }[];
}

export interface SideRecord {
  line: number;
  side: SideName;
  rejection: string | null;
}

/** Was the side swept, and given up? Lines on the ground are not swept. */
export function isRejected({ rejection }: SideRecord): boolean {
  return rejection !== null && rejection !== "on_ground";
}

export interface SimilarityCurve {
  reference: number | null;
  points: Vec2[];
  thetas: number[];
  similarity: number[];
  views: { view: number; valid: boolean; similarity: number[] }[];
  /** Density over theta at the samples, per radian, and the probability that a plane is there. */
  posterior: { density: number[]; plane: number };
}

export interface SideTrace extends SideRecord {
  curve: SimilarityCurve;
}

export interface WarpedViews {
  theta: number;
  reference: number;
  similarity: number;
  points: Vec2[];
  line_row: number;
  columns: number;
  rows: number;
  views: { view: number; similarity: number | null; valid: boolean; outline: Vec2[] | null }[];
}

/** Pictures one below the other, and what they show. */
export interface WarpedPicture {
  about: WarpedViews;
  rgba: Uint8ClampedArray<ArrayBuffer>;
}

export interface PlaneGroup {
  plane: Plane;
  members: { line: number; side: SideName | null; half_plane: number | null }[];
  /** Candidates of W96 in the plane. */
  rectangles?: number[];
}

export interface Grouping {
  groups: PlaneGroup[];
  plane_lines: { segment: Segment3; views: number[] }[];
  borders: { kind: "real" | "inplane" | "intersection" | "closing" | "rectangle"; a: Vec2; b: Vec2 }[];
  cells: number;
  rejected: { group?: number; outline: Vec3[]; reason: Record<string, Record<string, number>> }[];
}

/** A relation between sides of a building that was tested (B99 2). */
export interface TestedRelation {
  kind: "horizontal" | "parallel" | "perpendicular" | "equal_height" | "symmetric";
  sides: Segment3[];
  deviation_m: number;
  chi2: number;
  adopted: boolean;
}

/** What refinement made of a building. */
export interface BuildingRefinement {
  building: number;
  sides: number;
  sightings: number;
  error_before_px: number;
  error_after_px: number;
  largest_move_m: number;
  relations: TestedRelation[];
  refused: ({ reason: string } & Record<string, number | string>) | null;
}

export interface Refinement {
  /** Facets that were thought to meet, and the gap between them. */
  partings: { side: Segment3; width_m: number; gain_m2: number }[];
  before: {
    facets: Facet[];
    /** For every facet of the model which of these it was. */
    sources: number[];
  };
  trace: { buildings: BuildingRefinement[] };
}

/** W96 3.3. */
export interface Segmentation {
  regions: { area_px: number; perimeter_px: number; mean: number; variance: number; rings: Vec2[][] }[];
  vectors: { ends: [Vec2, Vec2]; sides: [number | null, number | null] }[];
  initial_regions: number;
  moves: Record<string, number>;
}

/** W96 3.4. */
export interface MainDirections {
  /** Of the first direction, from the X axis towards Y; the other is a right angle further. */
  azimuth: number;
  share: number;
}

export interface Directions {
  windows: { min: Vec2; max: Vec2; z_range_m: Vec2; directions: MainDirections[] }[];
  trace: {
    histograms: { histogram: number[]; bin_deg: number; found: MainDirections[] }[];
    lines: [Segment3, number | null][];
  };
}

/** W96 3.5: (across, height) in metres. */
export interface ClusterTrace {
  azimuth: number;
  lines: [number, [Vec2, Vec2]][];
  proposals: Vec2;
  selected: [Vec2, number][];
  refused: [Vec2, number][];
}

/** W96 3.6. */
export interface PlaneTrace {
  lines: Vec2;
  rejection: "shape" | "near_ground" | "no_ends" | "weak" | null;
  crossings: { view: number; at: Vec2; across: Vec2; contrast: number }[];
  ends: { at: Vec2; support: number }[];
}

export interface PlaneCandidate {
  plane: Plane;
  ring: Vec3[];
  lines: number[];
  support: number;
  correlation: number;
  measure: number;
}

export interface RectangleTrace {
  pairs: PlaneTrace[];
  candidates: PlaneCandidate[];
  chosen: number[];
}

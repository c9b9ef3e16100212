/**
 * What the core returns, as it crosses the worker boundary. Lengths in metres (local frame: the
 * input's map frame minus `SceneInfo.origin`, Z up), angles in radians, image positions in pixels
 * (x right, y down, the centre of the top-left pixel is (0.5, 0.5)).
 */

export type Vec3 = readonly [number, number, number];

/** What a dropped file was recognised as. */
export interface FileReport {
  path: string;
  kind: string;
  /** The kind in words. */
  description: string;
}

/** An image and its orientation. */
export interface ImageReport {
  path: string;
  name: string;
  /** Width and height in pixels; null when the header cannot be read. */
  size: [number, number] | null;
  /** Where its orientation stands; null when it has none. */
  orientation: string | null;
}

/** One of the orientations that a scene may be given. */
export interface OrientationReport {
  /** Its format and files, in words. */
  label: string;
  /** What `LoadOptions.orientation` chooses it by. */
  path: string;
}

/** What a set of files makes, known without decoding an image. */
export interface Inspection {
  files: FileReport[];
  images: ImageReport[];
  /** The orientation that a run would take. */
  orientation: string | null;
  /** All orientations among the files, the preferred one first. */
  orientations: OrientationReport[];
  /** Number of views that a run would use. */
  views: number;
  /** Memory that a run takes at its peak, about, megabytes; 0 where there are no views. */
  peak_mb: number;
  warnings: string[];
  /** Why a run would reject these files; empty when it would not. */
  errors: string[];
  /** Only the places of the cameras speak against them: loading looks at the images, and says more. */
  is_implausible: boolean;
}

/** What a person may ask for beyond the files. */
export interface LoadOptions {
  /** Path (or folder) of the orientation to take. */
  orientation?: string;
  /** Names of the images to use; all when absent. */
  views?: string[];
  /** Height of the ground, metres, in the frame of the orientation. */
  groundZ?: number;
  /** x0, y0, x1, y1, metres, in the frame of the orientation. */
  roi?: Region;
  /** Undo the mistake in the orientation that the images give away. */
  applyFix?: boolean;
  /** Adjust views that are turned or moved against the others by up to a few pixels. */
  adjust?: boolean;
  /** EPSG's number of the world's reference system. */
  epsg?: number;
}

/** x0, y0, x1, y1, metres. */
export type Region = [number, number, number, number];

/** What became of a tile of a large area. */
export interface TileReport {
  core: Region;
  outcome: string;
}

/** What a project file asks for; null stands for what it leaves open. */
export interface OpenedProject {
  options: { [K in keyof LoadOptions]-?: LoadOptions[K] | null };
  params: Params;
}

export interface ViewInfo {
  name: string;
  width: number;
  height: number;
  center: Vec3;
  /** Row-major 3 x 4 matrix from the local frame to pixels. */
  projection: number[];
}

/** How well images agree with an orientation: 0 is chance, 1 perfect. */
export interface Agreement {
  points: number;
  score: number;
}

/** What the images say of their orientation. */
export interface OrientationCheckReport {
  finding: "sound" | "unknown" | "explained" | "offset" | "odd" | "unexplained";
  stated: Agreement;
  cured: Agreement | null;
  /** Across the epipolar lines, as stated and without the mistake. */
  offsets_px: readonly [number, number] | null;
  /** The mistake that loading can undo. */
  mistake: string | null;
  /** What was assumed instead, the best first. */
  trials: { words: string; agreement: Agreement; all_pairs: boolean }[];
}

export interface SceneInfo {
  views: ViewInfo[];
  origin: Vec3;
  warnings: string[];
  doctor: OrientationCheckReport | null;
}

export interface StageSummary {
  stage: string;
  counts: Record<string, number>;
  warnings: string[];
}

export interface Plane {
  normal: Vec3;
  d: number;
}

export interface HalfPlane {
  line: number;
  side: "left" | "right";
  theta: number;
  sigma_theta?: number;
  similarity: number;
  curvature: number;
  amplitude: number;
  /** Posterior probability of a plane there. */
  probability: number;
  views: number[];
  plane: Plane;
}

export interface Facet {
  outer: Vec3[];
  holes: Vec3[][];
  plane: Plane;
  building: number;
  similarity: number;
  real_ratio?: number;
  lines?: number[];
  half_planes?: number[];
  /** Candidates of W96 with its plane. */
  rectangles?: number[];
}

export interface ViewImage {
  width: number;
  height: number;
  rgba: Uint8ClampedArray<ArrayBuffer>;
}

/** Parameters of one stage: what the core's defaults hold, whatever that is. */
export type ParamValue = number | boolean | string | null | ParamValue[] | { [key: string]: ParamValue };
export type ParamGroup = Record<string, ParamValue>;
export type Params = Record<string, ParamGroup>;

/** How a stretch of a matched line came about, as `matchedSegments` numbers it. */
export const SUPPORT_KINDS = ["matched", "merged", "grown"] as const;
export type SupportKind = (typeof SUPPORT_KINDS)[number];

/** Numbers per entry of the flat arrays. */
export const SEGMENT_STRIDE = 4;
export const SUPPORT_STRIDE = 6;
export const LINE_STRIDE = 6;
/** line, then p0 and p1 of a stretch. */
export const STRETCH_STRIDE = 7;
/** x0, y0, x1, y1, reason. */
export const REJECTED_STRIDE = 5;

/** Why a line of edgels is no segment, as `rejectedSegments` numbers it. */
export const SEGMENT_REJECTIONS = ["curved", "not significant", "beside an edge"] as const;

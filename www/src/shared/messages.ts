/** What page and worker say to each other: one union each way, discriminated by `type`. */
import type {
  Facet,
  HalfPlane,
  Inspection,
  LoadOptions,
  OpenedProject,
  OrientationCheckReport,
  Params,
  Region,
  SceneInfo,
  StageSummary,
  TileReport,
} from "./results";
import type * as traces from "./traces";

/** A file of the project. The page keeps the handle, so that a new worker can be given it again. */
export interface InputFile {
  path: string;
  blob: Blob;
}

export type Bytes = Uint8Array<ArrayBuffer>;

/** Which items of a map in a stage a worker does: every `of`-th, from `index`. */
export interface Shard {
  stage: string;
  map: string;
  index: number;
  of: number;
}

/** Every call that the worker answers: its arguments and its result. */
export interface Calls {
  open: { args: { wasmUrl: string }; result: { stages: string[]; defaults: Params } };
  setFiles: { args: { files: InputFile[] }; result: null };
  inspect: { args: { options: LoadOptions }; result: Inspection };
  load: { args: { options: LoadOptions }; result: SceneInfo };
  image: { args: { view: number }; result: ImageBitmap };
  setParams: { args: { params: Params }; result: null };
  run: { args: { stage: string }; result: StageSummary };
  segments: { args: { view: number }; result: Float32Array };
  matchedSegments: { args: { view: number }; result: Float32Array };
  lines: { args: object; result: Float64Array };
  halfPlanes: { args: object; result: HalfPlane[] };
  facets: { args: object; result: Facet[] };
  ask: { args: { query: QueryName; of: readonly unknown[] }; result: Queries[QueryName]["result"] };
  sharedMaps: { args: { stage: string }; result: { maps: string[]; withColours: boolean } };
  packView: { args: { view: number; withColours: boolean }; result: Bytes };
  takeView: { args: { view: number; of: number; packed: Bytes }; result: null };
  handOver: { args: { stage: string }; result: Bytes };
  takeOver: { args: { stage: string; found: Bytes }; result: null };
  computeShard: { args: Shard; result: Bytes };
  mergeShards: { args: { map: string; shards: Bytes[] }; result: null };
  exportNames: { args: object; result: string[] };
  exportFile: { args: { name: string }; result: Bytes };
  planTiles: { args: { options: LoadOptions; tileM: number }; result: Region[] };
  /** The next tile, which is the `index`-th of `of`; null when all are done. */
  runTile: { args: { stage: string; index: number; of: number }; result: TileReport | null };
  joinTiles: { args: object; result: null };
  exportProject: { args: { options: LoadOptions }; result: Bytes };
  openedProject: { args: object; result: OpenedProject | null };
}

/** Questions about the results, by the name of the session's method: they change nothing. */
export interface Queries {
  chosenStages: { args: []; result: string[] };
  rejectedSegments: { args: [view: number]; result: Float32Array };
  matching: { args: []; result: traces.MatchRecord | null };
  segmentStory: { args: [view: number, segment: number]; result: traces.SegmentStory | null };
  correspondence: {
    args: [view: number, segment: number, otherView: number, otherSegment: number, t: number];
    result: traces.Correspondence | null;
  };
  lineRecords: { args: []; result: traces.LineRecord[] };
  detectedStretches: { args: []; result: Float64Array };
  sides: { args: []; result: traces.SideRecord[] };
  side: { args: [line: number, left: boolean]; result: traces.SideTrace | null };
  warped: { args: [line: number, left: boolean, theta: number]; result: traces.WarpedPicture | null };
  grouping: { args: []; result: traces.Grouping | null };
  refinement: { args: []; result: traces.Refinement | null };
  regions: { args: [view: number]; result: traces.Segmentation | null };
  directions: { args: []; result: traces.Directions | null };
  clusters: { args: []; result: traces.ClusterTrace[] | null };
  rectangles: { args: []; result: traces.RectangleTrace | null };
}

export type QueryName = keyof Queries;

/** The names at run time: the worker calls no other method by name. */
export const QUERY_NAMES: readonly QueryName[] = [
  "chosenStages",
  "rejectedSegments",
  "matching",
  "segmentStory",
  "correspondence",
  "lineRecords",
  "detectedStretches",
  "sides",
  "side",
  "warped",
  "grouping",
  "refinement",
  "regions",
  "directions",
  "clusters",
  "rectangles",
];

export type CallName = keyof Calls;
export type Args<K extends CallName> = Calls[K]["args"];
export type Result<K extends CallName> = Calls[K]["result"];

/** Page to worker. */
export type Request = { [K in CallName]: { type: K; id: number; args: Args<K> } }[CallName];

/**
 * Why a call failed: the input is at fault; the core is, but it still runs; or it stopped for good and
 * the worker must be made anew.
 */
export type FailureKind = "input" | "internal" | "crash";

export interface Failure {
  message: string;
  kind: FailureKind;
  /** What the images say, where they speak against the orientation. */
  orientationCheck: OrientationCheckReport | null;
}

/** Worker to page. */
export type Reply =
  | { type: "done"; id: number; result: Result<CallName> }
  | ({ type: "failed"; id: number } & Failure)
  | { type: "progress"; stage: string; fraction: number };

/** What the page and a worker of the orientation say to each other; records are those of the core's second module. */
import type {
  MeasuredLength,
  OrientationReport,
  Orienter,
  OrientOptions,
  PairSummary,
  ViewInfo,
} from "../pkg-orient/orientation.js";
import type { Bytes } from "./calls";
import type { Outcome } from "./messages";

export type * from "../pkg-orient/orientation.js";

/** Where a photograph shows an end of a length, pixels. */
export interface LengthMark {
  file: string;
  x: number;
  y: number;
}

/** A block while it grows, or a finished one. */
export interface OrientedBlock {
  views: readonly ViewInfo[];
  /** x, y, z of each point. */
  points: Float32Array<ArrayBuffer>;
  /** Red, green, blue of each point. */
  colours: Uint8Array<ArrayBuffer>;
}

/** The calls that are not the orienter's own methods: they read files or report progress. */
interface OwnCalls {
  readFile(path: string, blob: Blob): Promise<Bytes>;
  readControl(path: string, blob: Blob): Promise<void>;
  runShard(map: string, index: number, of: number): Bytes;
  measureLength(ends: [LengthMark[], LengthMark[]]): MeasuredLength | string;
  connect(): PairSummary[];
  orient(): OrientationReport;
  block(): OrientedBlock;
}

type Inner = "free" | "readPhoto" | "setControl" | "views" | "points" | "colours" | typeof Symbol.dispose;

/** Every call that the worker answers. */
export type OrientCalls = Omit<Orienter, keyof OwnCalls | Inner> & OwnCalls;
export type OrientCallName = keyof OrientCalls;

/** Page to worker. */
export type OrientRequest =
  | { type: "open"; id: number; wasmUrl: string; options: OrientOptions }
  | { type: "call"; id: number; name: OrientCallName; args: readonly unknown[] };

/** Worker to page. */
export type OrientReply =
  | Outcome
  | { type: "progress"; fraction: number }
  | { type: "block"; block: OrientedBlock };

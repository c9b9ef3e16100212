/**
 * Every call that the worker answers: a method of the core's `Session`, by its name, arguments and result as the build
 * declares them, or one of `WorkerCalls`, which stand before the session's. A new method of the session can be
 * called from the page as it is.
 *
 * Rejected: Comlink. A call in flight has to fail when its worker is terminated, failures carry a kind and a report, and
 * calls must not overtake each other; around all of that, a proxy of its own is what the library would save.
 */
import type { Session } from "../pkg/ridgeline.js";
import type { ParamTree } from "./paramTree";
import type {
  GroundPicture,
  Inspection,
  LoadOptions,
  SceneInfo,
  StageSummary,
  TileReport,
  WarpedViews,
} from "./records";

/** A file of the project. The page keeps the handle, so that a new worker can be given it again. */
export interface InputFile {
  path: string;
  blob: Blob;
}

export type Bytes = Uint8Array<ArrayBuffer>;

/** Pictures one below the other, and what they show. */
export interface WarpedPicture {
  about: WarpedViews;
  rgba: Uint8ClampedArray<ArrayBuffer>;
}

/** The ground around the buildings, `about.height` rows of `about.width` texels. */
export interface GroundTexture {
  about: GroundPicture;
  rgba: Uint8ClampedArray<ArrayBuffer>;
}

/** The calls that are not the session's own methods: they read files, report progress or make pictures. */
export interface WorkerCalls {
  setFiles(files: readonly InputFile[]): Promise<void>;
  defaultParams(): ParamTree;
  setParams(params: ParamTree): void;
  image(view: number): Promise<ImageBitmap>;
  warped(line: number, left: boolean, theta: number): WarpedPicture | null;
  ground(): GroundTexture | null;
  runStage(stage: string): StageSummary;
  /** Null where views moved. */
  adjustOnce(): StageSummary | null;
  runShard(stage: string, map: string, index: number, of: number): Bytes;
  inspect(options: LoadOptions): Promise<Inspection>;
  load(options: LoadOptions): Promise<SceneInfo>;
  /** Lowest and highest ground as photographs in the middle of a flight show it, metres; null where they show too little. */
  groundHeights(options: LoadOptions): Promise<[number, number] | null>;
  exportProject(options: LoadOptions, shown: Uint8Array): Promise<Bytes>;
  /** The outcome of a tile of so many cells as bytes, after `done` of `of` others, with its progress as that of `stage`. */
  runTile(stage: string, index: number, cells: number, done: number, of: number): Promise<Bytes>;
  /** What a square shows at a first look, the `index`-th of `of`, as bytes, with its progress as that of `stage`. */
  lookAt(stage: string, index: number, of: number): Promise<Bytes>;
  tileModel(index: number, kept: Bytes): TileOutcome;
}

/** What a tile came to, and its model by itself, in the frame of the whole; null where it has none. */
export interface TileOutcome {
  report: TileReport;
  glb: Bytes | null;
}

/** What only the worker does to its session. */
type Inner =
  | "free"
  | "addFile"
  | "addHead"
  | "fillFile"
  | "fillRanges"
  | "emptyFiles"
  | "lackingFiles"
  | "groundFiles"
  | "groundFilesOfLoad"
  | "viewFilesOfLoad"
  | "groundFilesOfLook"
  | "viewFilesOfLook"
  | "groundFilesOfCell"
  | "viewFilesOfCell"
  | "loadCell"
  | "runCell"
  | "tileOutcome"
  | "clearFiles"
  | typeof Symbol.dispose;

type Calls = Omit<Session, keyof WorkerCalls | Inner> & WorkerCalls;
export type CallName = keyof Calls;
export type Args<K extends CallName> = Parameters<Calls[K]>;
export type Result<K extends CallName> = Awaited<ReturnType<Calls[K]>>;

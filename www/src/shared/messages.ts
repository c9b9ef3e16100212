/** What page and worker say to each other: one union each way, discriminated by `type`. */
import type {
  Facet,
  HalfPlane,
  Inspection,
  LoadOptions,
  Params,
  SceneInfo,
  StageSummary,
  ViewImage,
} from "./results";

/** A file of the project. The page keeps the handle, so that a new worker can be given it again. */
export interface InputFile {
  path: string;
  blob: Blob;
}

/** Every call that the worker answers: its arguments and its result. */
export interface Calls {
  open: { args: { wasmUrl: string }; result: { stages: string[]; defaults: Params } };
  setFiles: { args: { files: InputFile[] }; result: null };
  inspect: { args: { options: LoadOptions }; result: Inspection };
  load: { args: { options: LoadOptions }; result: SceneInfo };
  image: { args: { view: number }; result: ViewImage };
  setParams: { args: { params: Params }; result: null };
  run: { args: { stage: string }; result: StageSummary };
  segments: { args: { view: number }; result: Float32Array };
  matchedSegments: { args: { view: number }; result: Float32Array };
  lines: { args: object; result: Float64Array };
  halfPlanes: { args: object; result: HalfPlane[] };
  facets: { args: object; result: Facet[] };
  exportNames: { args: object; result: string[] };
  exportFile: { args: { name: string }; result: Uint8Array<ArrayBuffer> };
}

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

/** Worker to page. */
export type Reply =
  | { type: "done"; id: number; result: Result<CallName> }
  | { type: "failed"; id: number; message: string; kind: FailureKind }
  | { type: "progress"; stage: string; fraction: number };

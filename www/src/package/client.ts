/** The caller's side of the package: one worker, one reconstruction at a time, progress and cancel. */
import type { Facet, LoadOptions, Params, SceneInfo, StageSummary } from "../pkg/ridgeline.js";

export type { Facet, LoadOptions, Params, SceneInfo, StageSummary };

/** A file of a scene: photographs and their orientation, in any format that ridgeline reads. */
export interface SceneFile {
  /** Path within the scene; folders are separated by slashes. */
  path: string;
  /** Content. */
  bytes: Uint8Array | Blob;
}

/** How far a stage is. */
export interface Progress {
  /** Name of the stage; "load" while the scene is read. */
  stage: string;
  /** From 0 to 1. */
  fraction: number;
}

export interface ReconstructOptions {
  /** Which of the files to use, and how. */
  load?: LoadOptions;
  /** Parameters that differ from `Session.defaultParams()` of the wasm module, for example `{ method: "combined" }`. */
  params?: Params;
  /** Setbacks of your own beside the built-in ones of `roofs.json`: the text of a rule file. */
  setbacks?: string;
  onProgress?: (progress: Progress) => void;
  /** Cancels the reconstruction: its promise is rejected with the signal's reason. */
  signal?: AbortSignal;
}

export interface Reconstruction {
  scene: SceneInfo;
  /** The stages that ran, with their counts and warnings. */
  stages: StageSummary[];
  /** Roof facets, local frame: add `scene.origin` for the world frame of the input. */
  facets: Facet[];
  /** The files that the command line would write (CityJSON, glTF, lines ...), by name. */
  files: Map<string, Uint8Array>;
}

/** A worker with a core of its own. */
export interface RidgelineWorker {
  /** Reconstructs a scene; calls that overlap wait for each other. */
  reconstruct(files: readonly SceneFile[], options?: ReconstructOptions): Promise<Reconstruction>;
  /** Ends the worker. */
  close(): void;
}

/** The input was rejected: the message says which file, what was expected and what to do. */
export class InputError extends Error {
  override name = "InputError";
}

/** What is asked of the worker. */
export interface Request {
  files: { path: string; bytes: Uint8Array }[];
  load: LoadOptions;
  params: Params;
  setbacks?: string;
}

/** What the worker answers; the last reply to a request is "done" or "failed". */
export type Reply =
  | { type: "progress"; progress: Progress }
  | { type: "done"; result: Reconstruction }
  | { type: "failed"; isInput: boolean; message: string };

/** A worker of the browser or of Node. */
export interface Port {
  post(request: Request): void;
  /** Nothing is asked of it any more: it need not keep the program running. */
  rest(): void;
  terminate(): void;
}

/** Starts a worker; `onFailure` hears when it dies. */
export type Spawn = (onReply: (reply: Reply) => void, onFailure: (error: Error) => void) => Port;

/** A client over workers of the given kind. */
export function clientOf(spawn: Spawn): RidgelineWorker {
  let port: Port | null = null;
  let listener: { onReply: (reply: Reply) => void; onFailure: (error: Error) => void } | null = null;
  let queue: Promise<unknown> = Promise.resolve();

  const end = (): void => {
    port?.terminate();
    port = null;
  };

  const run = async (files: readonly SceneFile[], options: ReconstructOptions): Promise<Reconstruction> => {
    const { signal, onProgress } = options;
    signal?.throwIfAborted();
    const contents = files.map(async ({ path, bytes }) => ({ path, bytes: await bytesOf(bytes) }));
    const request = {
      files: await Promise.all(contents),
      load: options.load ?? {},
      params: options.params ?? {},
      ...(options.setbacks !== undefined && { setbacks: options.setbacks }),
    };
    signal?.throwIfAborted();
    port ??= spawn(
      (reply) => listener?.onReply(reply),
      (error) => listener?.onFailure(error),
    );
    let resolve: (result: Reconstruction) => void = () => {};
    let reject: (reason: unknown) => void = () => {};
    const promise = new Promise<Reconstruction>((...both) => {
      [resolve, reject] = both;
    });
    const cancel = (): void => {
      end();
      reject(signal?.reason);
    };
    signal?.addEventListener("abort", cancel, { once: true });
    listener = {
      onReply: (reply) => {
        if (reply.type === "progress") onProgress?.(reply.progress);
        else if (reply.type === "done") resolve(reply.result);
        else reject(reply.isInput ? new InputError(reply.message) : new Error(reply.message));
      },
      onFailure: (error) => {
        end();
        reject(error);
      },
    };
    port.post(request);
    try {
      return await promise;
    } finally {
      listener = null;
      port?.rest();
      signal?.removeEventListener("abort", cancel);
    }
  };

  return {
    reconstruct: (files, options = {}) => {
      const result = queue.then(() => run(files, options));
      queue = result.catch(() => undefined);
      return result;
    },
    close: () => {
      end();
      listener?.onFailure(new Error("The worker was closed."));
    },
  };
}

async function bytesOf(content: Uint8Array | Blob): Promise<Uint8Array> {
  return content instanceof Uint8Array ? content : new Uint8Array(await content.arrayBuffer());
}

/** Answers one call with the core's Session: convert, call, convert. No geometry, no state but the session. */
import type { Session } from "../pkg/ridgeline.js";
import type { CallName, InputFile, WorkerCalls } from "../shared/calls";
import { asTree } from "../shared/paramTree";
import type { GroundPicture, Params, Picture, ViewImage, WarpedViews } from "../shared/records";

export interface Answer {
  result: unknown;
  transfer: Transferable[];
}

/** Progress is a message at most every so often: the page cannot draw more. */
const PROGRESS_INTERVAL_MS = 40;

type OnProgress = (stage: string, fraction: number) => void;

/** The session; its pictures are objects of the core, of which only their fields are read. */
export type CoreSession = Omit<Session, "free" | typeof Symbol.dispose | "image" | "warped" | "ground"> & {
  image(view: number): FieldsOf<ViewImage>;
  warped(line: number, left: boolean, theta: number): FieldsOf<Picture> | undefined;
  ground(): FieldsOf<Picture> | undefined;
};
type FieldsOf<T> = Omit<T, "free" | typeof Symbol.dispose>;

/** What the session itself does not answer; `defaults` are the parameters that the class of the session has. */
export function workerCalls(
  session: CoreSession,
  defaults: () => Params,
  onProgress: OnProgress,
): WorkerCalls {
  return {
    setFiles: (files) => setFiles(session, files),
    defaultParams: () => asTree(defaults()),
    setParams: (params) => session.setParams(params as unknown as Params),
    image: async (view) => {
      const { rgba, width, height } = session.image(view);
      // The bitmap is made here: on the page it would hold everything else up.
      return createImageBitmap(new ImageData(rgba as Uint8ClampedArray<ArrayBuffer>, width, height));
    },
    warped: (line, left, theta) => pictureOf<WarpedViews>(session.warped(line, left, theta)),
    ground: () => pictureOf<GroundPicture>(session.ground()),
    runStage: (stage) => session.runStage(stage, throttled(stage, onProgress)),
    adjustOnce: () => session.adjustOnce(throttled("adjustment", onProgress)),
    runShard: (stage, map, index, of) =>
      session.runShard(stage, map, index, of, throttled(stage, onProgress)),
    runTile: (stage, index, of) => {
      const onTileProgress = throttled(stage, onProgress);
      return session.runTile((fraction) => onTileProgress((index + fraction) / of));
    },
  };
}

/** A picture of the core as a plain record. */
function pictureOf<T>(picture: FieldsOf<Picture> | undefined) {
  return picture === undefined
    ? null
    : { about: picture.about as T, rgba: picture.rgba as Uint8ClampedArray<ArrayBuffer> };
}

/** Answers a call by its name, with what moves to the page instead of being copied. */
export async function answer(
  session: CoreSession,
  own: WorkerCalls,
  name: CallName,
  args: readonly unknown[],
): Promise<Answer> {
  const target: object = name in own ? own : session;
  const method: unknown = Reflect.get(target, name);
  if (typeof method !== "function") {
    throw new Error(`There is no call '${name}'.`);
  }
  const result: unknown = await Reflect.apply(method, target, args);
  return { result, transfer: transferOf(result) };
}

/** Arrays that the core hands out are copies of its memory, so their buffers may move. */
function transferOf(result: unknown): Transferable[] {
  if (ArrayBuffer.isView(result)) {
    return [result.buffer as ArrayBuffer];
  }
  if (typeof ImageBitmap !== "undefined" && result instanceof ImageBitmap) {
    return [result];
  }
  if (typeof result === "object" && result !== null && "rgba" in result) {
    return transferOf(result.rgba);
  }
  return [];
}

async function setFiles(session: CoreSession, files: readonly InputFile[]): Promise<void> {
  session.clearFiles();
  for (const { path, blob } of files) {
    session.addFile(path, new Uint8Array(await readBlob(path, blob)));
  }
}

/** A file may have vanished since it was dropped: the browser's own message does not name it. */
export async function readBlob(path: string, blob: Blob): Promise<ArrayBuffer> {
  try {
    return await blob.arrayBuffer();
  } catch {
    throw new Error(`${path}: the file can no longer be read. Was it moved or changed? Add it again.`);
  }
}

/** Passes a stage's progress on, but not more often than the page can draw it. */
function throttled(stage: string, onProgress: OnProgress): (fraction: number) => void {
  let last = 0;
  return (fraction) => {
    const now = performance.now();
    if (now - last >= PROGRESS_INTERVAL_MS || fraction >= 1) {
      last = now;
      onProgress(stage, fraction);
    }
  };
}

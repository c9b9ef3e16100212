/** Answers one call with the core's Session: convert, call, convert. No geometry, no state but the session. */
import type { CallName, WorkerCalls } from "../shared/calls";
import { asTree } from "../shared/paramTree";
import type { GroundPicture, Params, Picture, WarpedViews } from "../shared/records";
import type { CoreSession, FieldsOf } from "./coreSession";
import { ProjectFiles } from "./projectFiles";

export interface Answer {
  result: unknown;
  transfer: Transferable[];
}

/** Progress is a message at most every so often: the page cannot draw more. */
const PROGRESS_INTERVAL_MS = 40;

type OnProgress = (stage: string, fraction: number) => void;

/** What the session itself does not answer; `defaults` are the parameters that the class of the session has. */
export function workerCalls(
  session: CoreSession,
  defaults: () => Params,
  onProgress: OnProgress,
): WorkerCalls {
  const files = new ProjectFiles(session);
  return {
    setFiles: (all) => files.replace(all),
    inspect: (options) =>
      files.withFilled([() => session.groundFilesOfLoad(options)], () => session.inspect(options)),
    load: (options) =>
      files.withFilled(
        [() => session.groundFilesOfLoad(options), () => session.viewFilesOfLoad(options)],
        () => session.load(options),
      ),
    groundHeights: (options) =>
      files.withFilled([() => session.groundFiles(options)], () => session.groundHeights(options)),
    exportProject: (options, shown) =>
      files.withFilled([() => session.lackingFiles()], () => session.exportProject(options, shown)),
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
      return files.withFilled(
        [() => session.groundFilesOfTile(index), () => session.viewFilesOfTile(index)],
        () => session.runTile(index, (fraction) => onTileProgress((index + fraction) / of)),
      );
    },
    lookAt: (stage, index, of) => {
      const onLookProgress = throttled(stage, onProgress);
      return files.withFilled(
        [() => session.groundFilesOfLook(index), () => session.viewFilesOfLook(index)],
        () => session.lookAt(index, (fraction) => onLookProgress((index + fraction) / of)),
      );
    },
    tileModel: (index, kept) => {
      const { report, glb } = session.tileModel(index, kept);
      return { report, glb: glb ?? null };
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
  if (typeof result === "object" && result !== null && "glb" in result) {
    return transferOf(result.glb);
  }
  return [];
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

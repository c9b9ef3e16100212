/** Answers one call with the core's Session: convert, call, convert. No geometry, no state but the session. */
import type { WorkerCalls } from "../shared/calls";
import { asTree } from "../shared/paramTree";
import type { GroundPicture, Params, Picture, WarpedViews } from "../shared/records";
import { throttled } from "./answering";
import type { CoreSession, FieldsOf } from "./coreSession";
import { ProjectFiles } from "./projectFiles";

type OnProgress = (stage: string, fraction: number) => void;

/** What the session itself does not answer; `defaults` are the parameters that the class of the session has. */
export function workerCalls(
  session: CoreSession,
  defaults: () => Params,
  onProgress: OnProgress,
): WorkerCalls {
  const files = new ProjectFiles(session);
  const progressOf = (stage: string) => throttled((fraction) => onProgress(stage, fraction));
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
    runStage: (stage) => session.runStage(stage, progressOf(stage)),
    adjustOnce: () => session.adjustOnce(progressOf("adjustment")),
    runShard: (stage, map, index, of) => session.runShard(stage, map, index, of, progressOf(stage)),
    runTile: async (stage, index, cells, done, of) => {
      const onTileProgress = progressOf(stage);
      for (let cell = 0; cell < cells; cell++) {
        await files.withFilled(
          [() => session.groundFilesOfCell(index, cell), () => session.viewFilesOfCell(index, cell)],
          () => session.loadCell(index, cell),
        );
        session.runCell(index, cell, (fraction) => onTileProgress((done + (cell + fraction) / cells) / of));
      }
      return session.tileOutcome(index);
    },
    lookAt: (stage, index, of) => {
      const onLookProgress = progressOf(stage);
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

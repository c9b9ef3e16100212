/** The worker and what keeps it fit: opening, loading, questions, and what is said when something fails. */

import { Engine, EngineError } from "../../core/engine";
import { WorkerPool } from "../../core/workerPool";
import type { Args, CallName, Result } from "../../shared/calls";
import type { SceneInfo } from "../../shared/records";
import { linkedParams } from "../settings/addressLink";
import { loadOptions } from "../settings/loadOptions";
import { paramsOf } from "../settings/parameterForm";
import { beginActivity, endActivity, isBusy } from "../state/activity";
import { notify } from "../state/notices";
import { method, params, replaceParams, setDefaults } from "../state/parameters";
import { files, inspection, runOptions, setInspection } from "../state/project";
import { images, setImages, setPeakMb, setScene } from "../state/scene";
import { replaceStages, runningStage, setFreshStages, stages, updateStage } from "../state/stages";
import { failureNotice } from "./failureNotice";
import { stagesOf } from "./stageCatalogue";

/** Whether the present worker holds the project's files, has the scene loaded, and was asked about them as they are wanted now. */
const held = { files: false, scene: false, inspection: false };

export const engine = new Engine((stage, fraction) => workerPool.engineReached(stage, fraction));
export const workerPool = new WorkerPool(engine, (name, fraction) => {
  const running = stages.value.find((stage) => stage.name === name && stage.status === "running");
  if (running !== undefined && fraction > running.fraction) {
    updateStage(name, { fraction });
  }
});

/** Compiles the core and reads its stages and defaults. */
export async function start(): Promise<void> {
  await guarded("Starting", async () => {
    await openEngine();
  });
}

/** Asks the core about its results; null while it has none, or is at work on others. */
export async function ask<K extends CallName>(call: K, ...of: Args<K>): Promise<Result<K> | null> {
  if (!held.scene || runningStage.peek() !== null) {
    return null;
  }
  try {
    return await engine.call(call, ...of);
  } catch (error) {
    await report(error);
    return null;
  }
}

/** Runs a task, shows what it is, and turns whatever it throws into a notice. */
export async function guarded<T>(what: string, task: () => Promise<T>): Promise<T | undefined> {
  beginActivity(what);
  try {
    return await task();
  } catch (error) {
    await report(error);
    return undefined;
  } finally {
    endActivity(what);
  }
}

async function report(error: unknown): Promise<void> {
  const { kind, orientationCheck } =
    error instanceof EngineError ? error : { kind: "internal" as const, orientationCheck: null };
  if (kind === "cancelled") {
    return;
  }
  notify(failureNotice(error instanceof Error ? error.message : String(error), kind, orientationCheck));
  if (kind === "crash") {
    forgetWorker();
    await start();
  }
}

async function openEngine(): Promise<void> {
  if (engine.isOpen) {
    return;
  }
  await engine.open();
  const defaults = await engine.call("defaultParams");
  setDefaults(defaults);
  if (stages.value.length === 0) {
    // With what has been chosen while the core was compiled.
    replaceParams(paramsOf(defaults, { ...linkedParams(), ...params.value }));
    await listStages();
  }
}

/** Gives the core the parameters, and shows the stages of the chosen method. */
export async function listStages(): Promise<void> {
  await openEngine();
  await engine.call("setParams", params.value);
  replaceStages(stagesOf(method.value));
}

/** Gives the worker the project's files, where it does not hold them yet. */
export async function ensureInspected(): Promise<void> {
  await openEngine();
  if (!held.files) {
    await engine.call("setFiles", files.value);
    held.files = true;
    // What is shown of the same files stays, and with it what a person is typing there.
    held.inspection = false;
  }
  if (inspection.value === null || !held.inspection) {
    // Of all images, also of those that are left out.
    const options = loadOptions({ ...runOptions.value, leftOut: [] }, null);
    setInspection(await engine.call("inspect", options));
    held.inspection = true;
  }
}

/** Has the worker load the scene: the replay after a cancelled run and the first load are the same. */
export async function ensureScene(): Promise<void> {
  await ensureInspected();
  if (!held.scene) {
    const options = loadOptions(runOptions.value, inspection.value);
    setPeakMb((await engine.call("inspect", options)).peak_mb);
    const loaded = await engine.call("load", options);
    held.scene = true;
    workerPool.forgetViews();
    setScene(loaded);
    if (images.value.length !== loaded.views.length) {
      setImages(await fetchImages(loaded));
    }
  }
  await engine.call("setParams", params.value);
}

async function fetchImages(loaded: SceneInfo): Promise<ImageBitmap[]> {
  const bitmaps: ImageBitmap[] = [];
  for (let view = 0; view < loaded.views.length; view += 1) {
    bitmaps.push(await engine.call("image", view));
  }
  return bitmaps;
}

/** Ends the worker if it is at work: what it does is out of date. */
export function stopWorker(): void {
  if (isBusy.value) {
    forgetWorker();
    engine.close();
  }
}

export function forgetWorker(): void {
  workerPool.close();
  outdateFiles();
}

/** There are other files than the worker's. */
export function outdateFiles(): void {
  held.files = false;
  outdateScene();
}

/** The scene is another one than the worker's, or the worker has dropped it. */
export function outdateScene(): void {
  held.scene = false;
  setFreshStages(0);
}

/** The files are wanted in another way than they were inspected for. */
export function outdateInspection(): void {
  held.inspection = false;
}

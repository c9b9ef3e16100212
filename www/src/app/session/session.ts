/** The worker and what keeps it fit: opening, loading, questions, and what is said when something fails. */

import { Engine, EngineError, isFatal } from "../../core/engine";
import { WorkerPool } from "../../core/workerPool";
import type { Args, CallName, Result } from "../../shared/calls";
import type { ParamTree } from "../../shared/paramTree";
import type { SceneInfo } from "../../shared/records";
import { flightPlan, showTileFraction, tileRun } from "../project/tiles/flight";
import { linkedParams } from "../settings/addressLink";
import { loadOptions } from "../settings/loadOptions";
import { paramsOf } from "../settings/parameterForm";
import { announce, notify } from "../state/notices";
import { params, replaceParams, setDefaults } from "../state/parameters";
import { files, inspection, projectStages, runOptions, setInspection } from "../state/project";
import { results, setExportNames } from "../state/results";
import { images, scene, setImages, setPeakMb, setScene } from "../state/scene";
import {
  haltStages,
  replaceStages,
  runningStage,
  setFreshStages,
  stages,
  updateStage,
} from "../state/stages";
import { ActionQueue } from "./actionQueue";
import { failureNotice } from "./failureNotice";

/** Whether the present worker holds the project's files, has the scene loaded, and was asked about them as they are wanted now. */
const held = { files: false, scene: false, inspection: false, results: null as object | null };

export const engine = new Engine(
  (stage, fraction) => workerPool.engineReached(stage, fraction),
  () => !actions.isEnding,
);
export const workerPool = new WorkerPool(engine, (name, fraction) => {
  if (tileRun.peek() !== null) {
    showTileFraction(fraction);
  }
  const running = stages.value.find((stage) => stage.name === name && stage.status === "running");
  if (running !== undefined && fraction > running.fraction) {
    updateStage(name, { fraction });
  }
});

/** All actions of the page, one at a time. */
export const actions = new ActionQueue({
  stop: (phase) => {
    if (phase === "run" || engine.isWorking) {
      forgetWorker();
      engine.close();
    }
  },
  failed: report,
});

/** Compiles the core and reads its stages and defaults. */
export function start(): Promise<void> {
  return actions.perform({ kind: "start", phase: "start", words: "Starting" }, openEngine);
}

/** Ends what is going on. What it had found stays on the page; the next run starts afresh. */
export async function cancel(): Promise<void> {
  if (actions.isIdle) {
    return;
  }
  await actions.perform({ kind: "cancel", phase: "start" }, async () => {
    haltStages();
    announce(
      flightPlan.value === null
        ? "Cancelled. The next run begins with the first stage."
        : "Cancelled. Tiles that are done are kept; the next run goes on with the others.",
    );
    await openEngine();
  });
}

/** Asks the core about its results; null while it has none, or is at work on others. */
export async function ask<K extends CallName>(call: K, ...of: Args<K>): Promise<Result<K> | null> {
  if (held.results === null || runningStage.peek() !== null) {
    return null;
  }
  const asked = results.peek();
  try {
    return await engine.call(call, ...of);
  } catch (error) {
    // Of results that have been replaced since, nobody wants to know.
    const isFailed = error instanceof EngineError && isFatal(error.kind);
    if (isFailed || (actions.isIdle && results.peek() === asked)) {
      await actions.perform({ kind: "start", name: "failed", phase: "start" }, () => report(error));
    }
    return null;
  }
}

/** Says what failed. A core that stopped is made anew, and given what it had. */
async function report(error: unknown): Promise<void> {
  const { kind, orientationCheck, during } =
    error instanceof EngineError ? error : { ...UNEXPECTED, kind: "internal" as const };
  if (kind === "cancelled") {
    return;
  }
  notify(failureNotice(messageOf(error), kind, orientationCheck, during));
  if (isFatal(kind)) {
    const hadScene = held.scene;
    forgetWorker();
    engine.close();
    try {
      // What stopped it while it loaded would stop it again.
      await (hadScene ? ensureScene() : openEngine());
    } catch (again) {
      if (!(again instanceof EngineError && again.kind === "cancelled")) {
        notify(failureNotice(messageOf(again), "crash"));
      }
    }
  }
}

const UNEXPECTED = { orientationCheck: null, during: null };

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

async function openEngine(): Promise<void> {
  if (actions.isEnding) {
    throw new EngineError("Cancelled.", "cancelled");
  }
  if (engine.isOpen) {
    return;
  }
  await engine.open();
  const defaults = await engine.call("defaultParams");
  setDefaults(defaults);
  if (stages.value.length === 0) {
    // With what has been chosen while the core was compiled.
    replaceParams(paramsOf(defaults, { ...linkedParams(), ...params.value }));
    await tellParams(params.value);
    replaceStages(projectStages.value);
  }
}

let told: ParamTree | null = null;

/** Gives the core the parameters: what it found with others it drops. */
export async function tellParams(values: ParamTree): Promise<void> {
  if (values !== told && held.results !== null) {
    noteResults();
  }
  told = values;
  await engine.call("setParams", values);
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
    replaceStages(projectStages.value);
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
  await tellParams(params.value);
}

/** Shows the views where they are now: the adjustment moves them, and changed parameters move them back. */
export async function followCameras(): Promise<void> {
  const found = await engine.call("scene");
  if (JSON.stringify(found.views) !== JSON.stringify(scene.value?.views)) {
    setScene(found);
  }
}

async function fetchImages(loaded: SceneInfo): Promise<ImageBitmap[]> {
  const bitmaps: ImageBitmap[] = [];
  for (let view = 0; view < loaded.views.length; view += 1) {
    bitmaps.push(await engine.call("image", view));
  }
  return bitmaps;
}

/** The worker is no more, and with it all that it had found. */
function forgetWorker(): void {
  workerPool.close();
  outdateFiles();
  setExportNames([]);
}

/** There are other files than the worker's. */
export function outdateFiles(): void {
  held.files = false;
  outdateScene();
}

/** The scene is another one than the worker's, or the worker has dropped it. */
export function outdateScene(): void {
  held.scene = false;
  dropResults();
  setFreshStages(0);
}

/** The files are wanted in another way than they were inspected for. */
export function outdateInspection(): void {
  held.inspection = false;
}

/** The worker has results of its own, and can be asked about them. */
export function noteResults(): void {
  held.results = {};
}

/** It has none, or others than the page shows. */
export function dropResults(): void {
  held.results = null;
}

/** Whether it can be asked. */
export function hasResults(): boolean {
  return held.results !== null;
}

/** What it holds, to be told from what it holds later. */
export function heldResults(): object | null {
  return held.results;
}

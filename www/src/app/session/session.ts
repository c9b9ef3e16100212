/** The worker and what keeps it fit: opening, loading, questions, and what is said when something fails. */

import { Engine, EngineError } from "../../core/engine";
import { Crew } from "../../core/workerPool";
import type { Queries, QueryName } from "../../shared/messages";
import type { SceneInfo } from "../../shared/results";
import { linkedParams } from "../settings/addressLink";
import { loadOptions } from "../settings/loadOptions";
import { paramsOf } from "../settings/parameterForm";
import {
  activity,
  announcement,
  defaults,
  files,
  freshStages,
  images,
  inspection,
  isBusy,
  type Notice,
  notices,
  params,
  peakMb,
  runningStage,
  runOptions,
  type StageState,
  scene,
  stages,
} from "../state/state";
import { failureNotice, withNotice } from "./failureNotice";

/** Whether the present worker holds the project's files, has the scene loaded, and was asked about them as they are wanted now. */
export const held = { files: false, scene: false, inspection: false };

export const engine = new Engine((stage, fraction) => crew.engineReached(stage, fraction));
export const crew = new Crew(engine, (name, fraction) => {
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
export async function ask<K extends QueryName>(
  query: K,
  ...of: Queries[K]["args"]
): Promise<Queries[K]["result"] | null> {
  if (!held.scene || runningStage.peek() !== null) {
    return null;
  }
  try {
    return await engine.ask(query, ...of);
  } catch (error) {
    await report(error);
    return null;
  }
}

let lastNotice = 0;

export function notify(notice: Omit<Notice, "id">): void {
  lastNotice += 1;
  notices.value = withNotice(notices.value, { ...notice, id: lastNotice });
}

export function dismiss(id: number): void {
  notices.value = notices.value.filter((notice) => notice.id !== id);
}

/** Runs a task, shows what it is, and turns whatever it throws into a notice. */
export async function guarded<T>(what: string, task: () => Promise<T>): Promise<T | undefined> {
  activity.value = what;
  try {
    return await task();
  } catch (error) {
    await report(error);
    return undefined;
  } finally {
    if (activity.value === what) {
      activity.value = "";
    }
  }
}

async function report(error: unknown): Promise<void> {
  const { kind, doctor } = error instanceof EngineError ? error : { kind: "internal" as const, doctor: null };
  if (kind === "cancelled") {
    return;
  }
  notify(failureNotice(error instanceof Error ? error.message : String(error), kind, doctor));
  if (kind === "crash") {
    forgetWorker();
    await start();
  }
}

async function openEngine(): Promise<void> {
  if (engine.isOpen) {
    return;
  }
  const core = await engine.open();
  defaults.value = core.defaults;
  if (stages.value.length === 0) {
    // With what has been chosen while the core was compiled.
    params.value = paramsOf(core.defaults, { ...linkedParams(), ...params.value });
    await listStages();
  }
}

/** Asks the core for the stages of the chosen method. */
export async function listStages(): Promise<void> {
  await openEngine();
  await engine.call("setParams", { params: params.value });
  const names = await engine.ask("chosenStages");
  if (names.join() !== stages.value.map(({ name }) => name).join()) {
    stages.value = names.map(freshStage);
  }
}

/** Gives the worker the project's files, where it does not hold them yet. */
export async function ensureInspected(): Promise<void> {
  await openEngine();
  if (!held.files) {
    await engine.call("setFiles", { files: files.value });
    held.files = true;
    // What is shown of the same files stays, and with it what a person is typing there.
    held.inspection = false;
  }
  if (inspection.value === null || !held.inspection) {
    // Of all images, also of those that are left out.
    const options = loadOptions({ ...runOptions.value, leftOut: [] }, null);
    inspection.value = await engine.call("inspect", { options });
    held.inspection = true;
  }
}

/** Has the worker load the scene: the replay after a cancelled run and the first load are the same. */
export async function ensureScene(): Promise<void> {
  await ensureInspected();
  if (!held.scene) {
    const options = loadOptions(runOptions.value, inspection.value);
    peakMb.value = (await engine.call("inspect", { options })).peak_mb;
    const loaded = await engine.call("load", { options });
    held.scene = true;
    crew.forgetViews();
    scene.value = loaded;
    if (images.value.length !== loaded.views.length) {
      images.value = await fetchImages(loaded);
    }
  }
  await engine.call("setParams", { params: params.value });
}

async function fetchImages(loaded: SceneInfo): Promise<ImageBitmap[]> {
  const bitmaps: ImageBitmap[] = [];
  for (let view = 0; view < loaded.views.length; view += 1) {
    bitmaps.push(await engine.call("image", { view }));
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
  crew.close();
  held.files = false;
  held.scene = false;
  freshStages.value = 0;
}

export function freshStage(name: string): StageState {
  return { name, status: "waiting", fraction: 0, seconds: null, counts: {}, warnings: [] };
}

export function updateStage(name: string, change: Partial<StageState>): void {
  stages.value = stages.value.map((stage) => (stage.name === name ? { ...stage, ...change } : stage));
}

export function say(text: string): void {
  announcement.value = text;
}

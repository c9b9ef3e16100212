/** Running stages, and what makes their results out of date. */
import { batch } from "@preact/signals";
import { EngineError } from "../../core/engine";
import type { Params, ParamValue } from "../../shared/results";
import { save } from "../project/inputFiles";
import { withParam } from "../settings/parameterForm";
import {
  activity,
  addResults,
  chosenWorkers,
  defaults,
  exportNames,
  freshStages,
  type Method,
  method,
  NO_RESULTS,
  params,
  runOptions,
  scene,
  selection,
  setResults,
  shownPlane,
  stages,
  tab,
  workers,
} from "../state/state";
import {
  crew,
  engine,
  ensureScene,
  forgetWorker,
  freshStage,
  guarded,
  listStages,
  notify,
  say,
  start,
  stopWorker,
  updateStage,
} from "./session";
import { firstStageOf, stageWords } from "./stageCatalogue";
import { fetchResults } from "./stageResults";
import { runTiles } from "./tiledRun";

/** Runs every stage up to `target` that the worker has not run with the present parameters. */
export async function runTo(target: string): Promise<void> {
  await guarded("", async () => {
    await ensureScene();
    const names = stages.value.map(({ name }) => name);
    const end = names.indexOf(target);
    for (let i = freshStages.value; i <= end; i += 1) {
      await runStage(names[i] as string);
      freshStages.value = i + 1;
    }
  });
}

export async function runAll(): Promise<void> {
  if (runOptions.value.tileM !== null) {
    await guarded("", () => runTiles(runOptions.value.tileM as number));
    return;
  }
  const last = stages.value.at(-1);
  if (last !== undefined) {
    await runTo(last.name);
  }
}

/** Ends the worker. What it had found stays on the page; the next run starts afresh. */
export async function cancel(): Promise<void> {
  forgetWorker();
  engine.close();
  batch(() => {
    activity.value = "";
    stages.value = stages.value.map((stage) =>
      stage.status === "running" ? { ...stage, status: "waiting", fraction: 0 } : stage,
    );
    exportNames.value = [];
  });
  say("Cancelled. The next run begins with the first stage.");
  await start();
}

/** Changes the parameter at a path of names; stages that depend on it become outdated. */
export function setParam(path: string, value: ParamValue): void {
  params.value = withParam(params.value, path, value);
  outdateFrom(
    firstStageOf(
      path,
      stages.value.map(({ name }) => name),
    ),
  );
}

/** Chooses the method: its stages take the place of the other's, and begin anew. */
export async function setMethod(next: Method): Promise<void> {
  if (next === method.value) {
    return;
  }
  stopWorker();
  batch(() => {
    params.value = { ...params.value, method: next as unknown as Params[string] };
    clearResults();
  });
  await guarded("", listStages);
}

export function resetParams(): void {
  const chosen = method.value as unknown as Params[string];
  params.value = { ...structuredClone(defaults.value), method: chosen };
  outdateFrom(0);
}

/** Saves one output file through the browser. */
export async function download(name: string): Promise<void> {
  await guarded(`Writing ${name}`, async () => {
    const bytes = await engine.call("exportFile", { name });
    save(name, new Blob([bytes], { type: mediaType(name) }));
  });
}

async function runStage(name: string): Promise<void> {
  const started = performance.now();
  updateStage(name, { status: "running", fraction: 0, warnings: [] });
  say(`${stageWords(name).title} running`);
  try {
    await shareStage(name);
    const summary = await engine.call("run", { stage: name });
    crew.hasRun(name);
    const found = await fetchResults(name);
    const seconds = (performance.now() - started) / 1000;
    const names = await engine.call("exportNames", {});
    batch(() => {
      addResults(stageWords(name).tab, found);
      exportNames.value = names;
      selection.value = null;
      tab.value = stageWords(name).tab;
      updateStage(name, { ...summary, status: "done", fraction: 1, seconds });
    });
    say(`${stageWords(name).title} done in ${seconds.toFixed(1)} s`);
  } catch (error) {
    const cancelled = error instanceof EngineError && error.kind === "cancelled";
    updateStage(name, { status: cancelled ? "waiting" : "failed", fraction: 0 });
    throw error;
  }
}

/** Has the helpers do their part of a stage. */
async function shareStage(stage: string): Promise<void> {
  const names = stages.value.map(({ name }) => name);
  const shared = await crew.share({
    stage,
    earlier: names.slice(0, names.indexOf(stage)),
    views: scene.value?.views.length ?? 0,
    params: params.value,
    workers: workers.value,
  });
  if (!shared) {
    chosenWorkers.value = 1;
    notify({
      severity: "warning",
      title: "A worker stopped",
      text: "The computation goes on with one worker: there may not be memory for more.",
    });
  }
}

function outdateFrom(index: number): void {
  freshStages.value = Math.min(freshStages.value, index);
  stages.value = stages.value.map((stage, i) =>
    i >= index && stage.status === "done" ? { ...stage, status: "outdated" } : stage,
  );
}

export function clearResults(): void {
  freshStages.value = 0;
  setResults(NO_RESULTS);
  exportNames.value = [];
  selection.value = null;
  shownPlane.value = 0;
  tab.value = "images";
  stages.value = stages.value.map(({ name }) => freshStage(name));
}

function mediaType(name: string): string {
  return name.endsWith(".json") ? "application/json" : "application/octet-stream";
}

/** Running stages, and what makes their results out of date. */
import { batch } from "@preact/signals";
import { EngineError } from "../../core/engine";
import type { ParamTree, ParamValue } from "../../shared/paramTree";
import type { StageName } from "../../shared/stages";
import { saveFile } from "../parts/saveFile";
import { withParam } from "../settings/parameterForm";
import { endAllActivity } from "../state/activity";
import type { Method } from "../state/methods";
import { announce, notify } from "../state/notices";
import { defaults, method, params, replaceParams } from "../state/parameters";
import { runOptions } from "../state/project";
import { addResults, NO_RESULTS, setExportNames, setResults } from "../state/results";
import { scene } from "../state/scene";
import {
  freshStages,
  haltStages,
  outdateStages,
  restartStages,
  setFreshStages,
  stages,
  updateStage,
} from "../state/stages";
import { select, showPlane, showTab } from "../state/viewState";
import { chooseWorkers, workers } from "../state/workers";
import {
  engine,
  ensureScene,
  forgetWorker,
  guarded,
  listStages,
  start,
  stopWorker,
  workerPool,
} from "./session";
import { firstStageOf, stageWords } from "./stageCatalogue";
import { fetchResults } from "./stageResults";
import { runTiles } from "./tiledRun";

/** Runs every stage up to `target` that the worker has not run with the present parameters. */
export async function runTo(target: StageName): Promise<void> {
  await guarded("", async () => {
    await ensureScene();
    const names = stages.value.map(({ name }) => name);
    const end = names.indexOf(target);
    for (let i = freshStages.value; i <= end; i += 1) {
      await runStage(names[i] as StageName);
      setFreshStages(i + 1);
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
    endAllActivity();
    haltStages();
    setExportNames([]);
  });
  announce("Cancelled. The next run begins with the first stage.");
  await start();
}

/** Changes the parameter at a path of names; stages that depend on it become outdated. */
export function setParam(path: string, value: ParamValue): void {
  replaceParams(withParam(params.value, path, value));
  outdateStages(
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
    replaceParams({ ...params.value, method: next as unknown as ParamTree[string] });
    clearResults();
  });
  await guarded("", listStages);
}

export function resetParams(): void {
  const chosen = method.value as unknown as ParamTree[string];
  replaceParams({ ...structuredClone(defaults.value), method: chosen });
  outdateStages(0);
}

/** Saves one output file through the browser. */
export async function download(name: string): Promise<void> {
  await guarded(`Writing ${name}`, async () => {
    const bytes = await engine.call("exportFile", name);
    saveFile(name, new Blob([bytes], { type: mediaType(name) }));
  });
}

async function runStage(name: StageName): Promise<void> {
  const started = performance.now();
  updateStage(name, { status: "running", fraction: 0, warnings: [] });
  announce(`${stageWords(name).title} running`);
  try {
    await runShards(name);
    const summary = await engine.call("runStage", name);
    workerPool.hasRun(name);
    const found = await fetchResults(name);
    const seconds = (performance.now() - started) / 1000;
    const names = await engine.call("exportNames");
    batch(() => {
      addResults(name, found);
      setExportNames(names);
      select(null);
      showTab(name);
      updateStage(name, { ...summary, status: "done", fraction: 1, seconds });
    });
    announce(`${stageWords(name).title} done in ${seconds.toFixed(1)} s`);
  } catch (error) {
    const cancelled = error instanceof EngineError && error.kind === "cancelled";
    updateStage(name, { status: cancelled ? "waiting" : "failed", fraction: 0 });
    throw error;
  }
}

/** Has the worker pool compute its shards of a stage. */
async function runShards(stage: StageName): Promise<void> {
  const names = stages.value.map(({ name }) => name);
  const isMerged = await workerPool.runShards({
    stage,
    earlier: names.slice(0, names.indexOf(stage)),
    views: scene.value?.views.length ?? 0,
    params: params.value,
    workers: workers.value,
  });
  if (!isMerged) {
    chooseWorkers(1);
    notify({
      severity: "warning",
      title: "A worker stopped",
      text: "The computation goes on with one worker: there may not be memory for more.",
    });
  }
}

export function clearResults(): void {
  restartStages();
  setResults(NO_RESULTS);
  setExportNames([]);
  select(null);
  showPlane(0);
  showTab("images");
}

function mediaType(name: string): string {
  return name.endsWith(".json") ? "application/json" : "application/octet-stream";
}

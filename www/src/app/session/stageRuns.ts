/** Running stages, and what makes their results out of date. */
import { batch } from "@preact/signals";
import { EngineError } from "../../core/engine";
import type { ParamTree, ParamValue } from "../../shared/paramTree";
import type { ComparedModels } from "../../shared/records";
import type { Method, StageName } from "../../shared/stages";
import {
  firstStageOf,
  METHOD_WORDS,
  mainTabOf,
  methodOf,
  shownTabOf,
  stageWords,
} from "../../stages/catalogue";
import { fetchResults } from "../../stages/list";
import { saveFile } from "../parts/saveFile";
import { changedParams, fieldText, paramName, withParam } from "../settings/parameterForm";
import { isBusy } from "../state/activity";
import { announce, dismissOffers, notify } from "../state/notices";
import { defaults, method, params, replaceParams } from "../state/parameters";
import { files, hasPhotographsOnly, projectStages, runOptions } from "../state/project";
import {
  addResults,
  exportNames,
  mainResults,
  NO_RESULTS,
  preliminaryFacets,
  setExportNames,
  setResults,
} from "../state/results";
import { scene } from "../state/scene";
import {
  beginStage,
  endStage,
  freshStages,
  outdateStages,
  replaceStages,
  restartStages,
  stages,
  updateStage,
} from "../state/stages";
import { beginLeading, leadTo, select, showPlane, showTab, tab } from "../state/viewState";
import { chooseWorkers, workers } from "../state/workers";
import type { Turn } from "./actionQueue";
import { workerNotice } from "./failureNotice";
import { beginFirstLook, endFirstLook } from "./firstLook";
import { showFound } from "./foundBefore";
import {
  actions,
  engine,
  ensureScene,
  followCameras,
  hasResults,
  noteResults,
  tellParams,
  workerPool,
} from "./session";
import { noteStep, UNDO_ADDING } from "./steps";
import { runTiles } from "./tiledRun";

/** Runs every stage up to `target` that the worker has not run with the present parameters. */
export function runTo(target: StageName): Promise<void> {
  return actions.perform({ kind: "run", name: target, phase: "run" }, (turn) => runStages(turn, target));
}

/** Runs all stages, or the tiles of a large area. */
export function runAll(): Promise<void> {
  return actions.perform({ kind: "run", name: "all", phase: "run" }, runEverything);
}

/** The same as part of another action. */
export async function runEverything(turn: Turn): Promise<void> {
  turn.enter("run");
  dismissOffers("Run all");
  const { tileM } = runOptions.value;
  const last = stages.value.at(-1);
  if (tileM !== null) {
    await runTiles(turn, tileM);
  } else if (last !== undefined) {
    await runStages(turn, last.name);
  }
}

/** Runs up to a stage as part of another action. */
export async function runStages(turn: Turn, target: StageName): Promise<void> {
  turn.enter("run");
  if (files.value.length === 0) {
    return;
  }
  dismissOffers(UNDO_ADDING);
  workerPool.hire(workers.value);
  await ensureScene();
  const names = stages.value.map(({ name }) => name);
  const end = names.indexOf(target);
  beginLeading();
  if (freshStages.value === 0 && names[end] === "model") {
    await beginFirstLook();
  }
  try {
    // A parameter that is changed meanwhile sets back which stages are up to date, and so do views that move.
    for (let i = freshStages.value; i <= end; i = freshStages.value) {
      const taken = params.value;
      beginStage(i);
      await tellParams(taken);
      await runStage(names[i] as StageName, i, taken);
    }
  } finally {
    endFirstLook();
  }
}

/** Whether there is something to run among the first `count` stages, and nothing else going on. */
export function canRun(count: number): boolean {
  return files.value.length > 0 && !hasPhotographsOnly.value && !isBusy.value && freshStages.value < count;
}

/** Changes the parameter at a path of names, as a step with these words. */
export function setParam(
  path: string,
  value: ParamValue,
  what = `${paramName(path)}: ${fieldText(value)}`,
): void {
  noteStep(what, path);
  changeParam(path, value);
}

/** The same as part of another step. */
export function changeParam(path: string, value: ParamValue): void {
  changeParams(withParam(params.value, path, value), [path]);
}

/**
 * Takes other parameters: stages that depend on what changed become outdated, or those of another method take their place;
 * what was found with the same parameters before is shown again. The core is told when it runs.
 */
export function changeParams(
  next: ParamTree,
  paths: readonly string[] = Object.keys(changedParams(params.value, next)),
): void {
  const names = stages.value.map(({ name }) => name);
  const isOtherMethod = methodOf(next) !== method.value;
  batch(() => {
    replaceParams(next);
    if (isOtherMethod) {
      // Until the core is compiled there are none.
      if (stages.value.length > 0) {
        replaceStages(projectStages.value);
      }
      clearResults();
    } else {
      outdateStages(Math.min(names.length, ...paths.map((path) => firstStageOf(path, names))));
    }
    if (showFound() && isOtherMethod && mainResults.value.glb !== null) {
      showTab("model");
    }
  });
}

/** Chooses the method: its stages take the place of the other's, with what they have found before. */
export async function setMethod(next: Method): Promise<void> {
  if (next !== method.value) {
    await actions.perform({ kind: "method", phase: "load" }, () => chooseMethod(next));
  }
}

/** The same as part of another action. */
export function chooseMethod(next: Method): void {
  noteStep(`Method: ${METHOD_WORDS[next].title}`, "method");
  changeParams({ ...params.value, method: next as unknown as ParamTree[string] });
}

export function resetParams(): void {
  const chosen = method.value as unknown as ParamTree[string];
  const { corrections } = params.value;
  const kept = corrections === undefined ? {} : { corrections };
  noteStep("Parameters reset", "parameters");
  changeParams({ ...structuredClone(defaults.value), method: chosen, ...kept });
}

/** Saves one output file through the browser. */
export async function download(name: string): Promise<void> {
  const bytes = await outputFile(name);
  if (bytes !== null) {
    saveFile(name, new Blob([bytes], { type: mediaType(name) }));
  }
}

/**
 * An output file; null where there is none, or something else took its turn. With `setbacks`, the text of a rule file,
 * the files of the report are made anew before.
 */
export async function outputFile(name: string, setbacks?: string): Promise<Uint8Array<ArrayBuffer> | null> {
  const words = `Writing ${name}`;
  let bytes: Uint8Array<ArrayBuffer> | null = null;
  await actions.perform({ kind: "save", name, phase: "save", words }, async (turn) => {
    // What it waited for may have taken the results away.
    if (exportNames.value.includes(name)) {
      await ensureResults(turn, words);
      if (setbacks !== undefined) {
        await engine.call("reportWith", setbacks);
      }
      bytes = await engine.call("exportFile", name);
    }
  });
  return bytes;
}

/** What the model has in common with another one, and by how much they differ; null where something else took its turn. */
export async function compareModel(other: File): Promise<ComparedModels | null> {
  const words = `Comparing with ${other.name}`;
  let found: ComparedModels | null = null;
  await actions.perform({ kind: "save", name: other.name, phase: "save", words }, async (turn) => {
    const bytes = new Uint8Array(await other.arrayBuffer());
    await ensureResults(turn, words);
    found = await engine.call("compareWith", bytes);
  });
  return found;
}

/** Of an earlier visit the page has what it shows; the same input gives the same results. */
async function ensureResults(turn: Turn, words: string): Promise<void> {
  if (!hasResults() && stages.value.length > 0) {
    await runEverything(turn);
    turn.enter("save", words);
  }
}

async function runStage(name: StageName, position: number, taken: ParamTree): Promise<void> {
  const started = performance.now();
  updateStage(name, { status: "running", fraction: 0, warnings: [] });
  announce(`${stageWords(name).title} running`);
  try {
    await runShards(name, taken);
    const isAdjustment = name === "adjustment";
    const summary = await (isAdjustment ? engine.call("adjustOnce") : engine.call("runStage", name));
    await followCameras();
    if (summary === null) {
      updateStage(name, { status: "waiting", fraction: 0 });
      outdateStages(stages.value.findIndex((stage) => stage.name === "matches"));
      return;
    }
    workerPool.hasRun(name);
    noteResults();
    const found = await fetchResults(name, {
      call: (...asked) => engine.call(...asked),
      views: scene.value?.views.length ?? 0,
      params: params.value,
    });
    const seconds = (performance.now() - started) / 1000;
    const names = await engine.call("exportNames");
    batch(() => {
      addResults(mainTabOf(name), found);
      setExportNames(names);
      select(null);
      // A preliminary model is looked at until its own facets take its place.
      const shown = shownTabOf(name, method.value);
      if (shown !== null && (preliminaryFacets.value === null || tab.value !== "model")) {
        leadTo(shown);
      }
      updateStage(name, { ...summary, status: "done", fraction: 1, seconds });
      endStage(position);
    });
    announce(`${stageWords(name).title} done in ${seconds.toFixed(1)} s`);
  } catch (error) {
    const cancelled = error instanceof EngineError && error.kind === "cancelled";
    updateStage(name, { status: cancelled ? "waiting" : "failed", fraction: 0 });
    if (error instanceof EngineError) {
      error.during = stageWords(name).title;
    }
    throw error;
  }
}

/** Has the worker pool compute its shards of a stage. */
async function runShards(stage: StageName, taken: ParamTree): Promise<void> {
  const names = stages.value.map(({ name }) => name);
  const failure = await workerPool.runShards({
    stage,
    earlier: names.slice(0, names.indexOf(stage)),
    views: scene.value?.views.length ?? 0,
    params: taken,
    workers: workers.value,
  });
  if (failure !== null) {
    chooseWorkers(1);
    notify(workerNotice(failure));
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

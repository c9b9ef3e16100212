/** What a person can do, and what follows from it: the only place that talks to the worker. */
import { batch } from "@preact/signals";
import type { InputFile, Queries, QueryName } from "../shared/messages";
import type { Params, ParamValue, SceneInfo } from "../shared/results";
import { Crew } from "./crew";
import { Engine, EngineError } from "./engine";
import { save } from "./files";
import type { Kept } from "./keep";
import { linkedParams } from "./link";
import { failureNotice } from "./notices";
import { changedParams, paramsOf, withParam } from "./paramForm";
import { loadOptions } from "./runOptions";
import { firstStageOf, stageWords } from "./stages";
import {
  activity,
  announcement,
  chosenWorkers,
  defaults,
  exportNames,
  files,
  freshStages,
  images,
  inspection,
  isBusy,
  isDemo,
  keptResult,
  type Method,
  method,
  NO_OPTIONS,
  NO_RESULTS,
  type Notice,
  notices,
  params,
  projectName,
  type Results,
  type RunOptions,
  results,
  runningStage,
  runOptions,
  type StageState,
  scene,
  selection,
  shownPlane,
  shownView,
  stages,
  tab,
  workers,
} from "./state";

const engine = new Engine((stage, fraction) => crew.engineReached(stage, fraction));
const crew = new Crew(engine, (name, fraction) => {
  const running = stages.value.find((stage) => stage.name === name && stage.status === "running");
  if (running !== undefined && fraction > running.fraction) {
    updateStage(name, { fraction });
  }
});

/** Whether the present worker holds the project's files, and has the scene loaded. */
let filesInWorker = false;
let sceneInWorker = false;
let lastNotice = 0;

/** So many refusals are shown at once: the first ones usually explain the others. */
const MAX_PROBLEMS = 4;

/** Compiles the core and reads its stages and defaults. */
export async function start(): Promise<void> {
  await guarded("Starting", async () => {
    await openEngine();
  });
}

/** Adds files (the same path replaces), inspects them, and loads the scene once it looks whole. */
export async function addFiles(added: InputFile[], name?: string): Promise<void> {
  if (added.length === 0) {
    return;
  }
  const byPath = new Map(files.value.map((file) => [file.path, file]));
  for (const file of added) {
    byPath.set(file.path, file);
  }
  if (name !== undefined || projectName.value === "") {
    projectName.value = name ?? "Own files";
  }
  await setProject([...byPath.values()]);
}

export async function removeFile(path: string): Promise<void> {
  await removing(path.slice(path.lastIndexOf("/") + 1), () =>
    setProject(files.value.filter((file) => file.path !== path)),
  );
}

export async function clearProject(): Promise<void> {
  await removing("The project", async () => {
    projectName.value = "";
    await setProject([]);
  });
}

/** Removes something, and offers to take that back. */
async function removing(what: string, remove: () => Promise<void>): Promise<void> {
  const before: Kept = {
    name: projectName.value,
    isDemo: isDemo.value,
    files: files.value,
    options: runOptions.value,
    params: params.value,
  };
  await remove();
  notify({
    severity: "info",
    title: `${what} was removed`,
    text: "",
    action: { name: "Undo", run: () => void restoreProject(before) },
  });
}

/** Takes up the project of the last visit. */
export async function restoreProject(kept: Kept): Promise<void> {
  projectName.value = kept.name;
  runOptions.value = kept.options;
  const linked = linkedParams();
  params.value = paramsOf(defaults.value, { ...changedParams(defaults.value, kept.params), ...linked });
  await guarded("", listStages);
  await setProject(kept.files);
  isDemo.value = kept.isDemo;
}

/**
 * Fetches the demo scene from this site and drops it in as if it were the user's; then runs it up to a stage: the last
 * one unless another is named, none for null.
 */
export async function openDemo(target?: string | null): Promise<void> {
  const fetched = await guarded("Fetching the demo scene", fetchDemo);
  if (fetched === undefined) {
    return;
  }
  files.value = [];
  runOptions.value = NO_OPTIONS;
  await addFiles(fetched.files, fetched.title);
  isDemo.value = true;
  if (target === undefined) {
    await runAll();
  } else if (target !== null) {
    await runTo(target);
  }
}

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

/** Changes what is asked for beyond the files, and loads the scene again. */
export async function setRunOptions(change: Partial<RunOptions>): Promise<void> {
  stopWorker();
  sceneInWorker = false;
  freshStages.value = 0;
  batch(() => {
    runOptions.value = { ...runOptions.value, ...change };
    if (change.orientation !== undefined) {
      inspection.value = null;
    }
    notices.value = [];
    clearScene();
  });
  await loadProject("Loading");
}

/** Saves one output file through the browser. */
export async function download(name: string): Promise<void> {
  await guarded(`Writing ${name}`, async () => {
    const bytes = await engine.call("exportFile", { name });
    save(name, new Blob([bytes], { type: mediaType(name) }));
  });
}

/** Asks the core about its results; null while it has none, or is at work on others. */
export async function ask<K extends QueryName>(
  query: K,
  ...of: Queries[K]["args"]
): Promise<Queries[K]["result"] | null> {
  if (!sceneInWorker || runningStage.peek() !== null) {
    return null;
  }
  try {
    return await engine.ask(query, ...of);
  } catch (error) {
    await report(error);
    return null;
  }
}

export function notify(notice: Omit<Notice, "id">): void {
  lastNotice += 1;
  notices.value = [...notices.value, { ...notice, id: lastNotice }];
}

export function dismiss(id: number): void {
  notices.value = notices.value.filter((notice) => notice.id !== id);
}

/** Ends the worker if it is at work: what it does is out of date. */
function stopWorker(): void {
  if (isBusy.value) {
    forgetWorker();
    engine.close();
  }
}

async function setProject(next: InputFile[]): Promise<void> {
  stopWorker();
  filesInWorker = false;
  sceneInWorker = false;
  freshStages.value = 0;
  batch(() => {
    files.value = next;
    isDemo.value = false;
    inspection.value = null;
    notices.value = [];
    runOptions.value = next.length === 0 ? NO_OPTIONS : runOptions.value;
    clearScene();
  });
  await loadProject("Reading files");
}

/** Inspects the files, says what stands against them, or loads the scene. */
async function loadProject(what: string): Promise<void> {
  if (files.value.length === 0) {
    return;
  }
  await guarded(what, async () => {
    await ensureInspected();
    const problems = inspection.value?.errors ?? [];
    // The inspection is of all images, and does not look into them: where that matters, loading says
    // what is wrong.
    const isFinal = runOptions.value.leftOut.length === 0 && inspection.value?.is_implausible !== true;
    if (problems.length === 0 || !isFinal) {
      await ensureScene();
      return;
    }
    for (const problem of problems.slice(0, MAX_PROBLEMS)) {
      notify(failureNotice(problem, "input"));
    }
  });
}

function clearScene(): void {
  for (const image of images.value) {
    image.close();
  }
  scene.value = null;
  images.value = [];
  shownView.value = 0;
  keptResult.value = null;
  clearResults();
}

function clearResults(): void {
  freshStages.value = 0;
  results.value = NO_RESULTS;
  exportNames.value = [];
  selection.value = null;
  shownPlane.value = 0;
  tab.value = "images";
  stages.value = stages.value.map(({ name }) => freshStage(name));
}

async function openEngine(): Promise<void> {
  if (engine.isOpen) {
    return;
  }
  const core = await engine.open();
  defaults.value = core.defaults;
  if (stages.value.length === 0) {
    params.value = paramsOf(core.defaults, linkedParams());
    await listStages();
  }
}

/** Asks the core for the stages of the chosen method. */
async function listStages(): Promise<void> {
  await openEngine();
  await engine.call("setParams", { params: params.value });
  const names = await engine.ask("chosenStages");
  if (names.join() !== stages.value.map(({ name }) => name).join()) {
    stages.value = names.map(freshStage);
  }
}

/** Gives the worker the project's files, where it does not hold them yet. */
async function ensureInspected(): Promise<void> {
  await openEngine();
  if (!filesInWorker) {
    await engine.call("setFiles", { files: files.value });
    filesInWorker = true;
    inspection.value = null;
  }
  if (inspection.value === null) {
    const { orientation } = runOptions.value;
    inspection.value = await engine.call("inspect", { options: orientation === null ? {} : { orientation } });
  }
}

/** Has the worker load the scene: the replay after a cancelled run and the first load are the same. */
async function ensureScene(): Promise<void> {
  await ensureInspected();
  if (!sceneInWorker) {
    const loaded = await engine.call("load", {
      options: loadOptions(runOptions.value, inspection.value),
    });
    sceneInWorker = true;
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
      results.value = { ...results.value, ...found };
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

/** What a stage adds to the results. */
async function fetchResults(stage: string): Promise<Partial<Results>> {
  switch (stage) {
    case "segments":
      return { segments: await perView("segments"), rejected: await askViews("rejectedSegments") };
    case "matches":
      return { supports: await perView("matchedSegments"), matching: await engine.ask("matching") };
    case "lines":
      return {
        ...(await fetchLines()),
        stretches: await engine.ask("detectedStretches"),
      };
    case "halfplanes":
      return { halfPlanes: await engine.call("halfPlanes", {}), sides: await engine.ask("sides") };
    case "facets":
      return { facets: await engine.call("facets", {}), grouping: await engine.ask("grouping") };
    case "regions":
      return { segments: await perView("segments"), regions: (await askViews("regions")).filter(isPresent) };
    case "directions":
      return { directions: await engine.ask("directions") };
    case "clusters":
      return { ...(await fetchLines()), clusters: await engine.ask("clusters") };
    case "rectangles":
      return { facets: await engine.call("facets", {}), rectangles: await engine.ask("rectangles") };
    case "model":
      return { glb: await engine.call("exportFile", { name: "model.glb" }) };
    default:
      return {};
  }
}

async function fetchLines(): Promise<Partial<Results>> {
  return {
    supports: await perView("matchedSegments"),
    lines: await engine.call("lines", {}),
    records: await engine.ask("lineRecords"),
  };
}

/** The answers for all views. */
function askViews<K extends "rejectedSegments" | "regions">(query: K): Promise<Queries[K]["result"][]> {
  const views = scene.value?.views ?? [];
  return Promise.all(views.map((_, view) => engine.ask(query, view)));
}

function isPresent<T>(value: T | null): value is T {
  return value !== null;
}

function perView(call: "segments" | "matchedSegments"): Promise<Float32Array[]> {
  const views = scene.value?.views ?? [];
  return Promise.all(views.map((_, view) => engine.call(call, { view })));
}

function outdateFrom(index: number): void {
  freshStages.value = Math.min(freshStages.value, index);
  stages.value = stages.value.map((stage, i) =>
    i >= index && stage.status === "done" ? { ...stage, status: "outdated" } : stage,
  );
}

/** Runs a task, shows what it is, and turns whatever it throws into a notice. */
async function guarded<T>(what: string, task: () => Promise<T>): Promise<T | undefined> {
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

function forgetWorker(): void {
  crew.close();
  filesInWorker = false;
  sceneInWorker = false;
  freshStages.value = 0;
}

async function fetchDemo(): Promise<{ title: string; files: InputFile[] }> {
  const folder = new URL("demo/", document.baseURI);
  const manifest = (await (await fetchOk(new URL("manifest.json", folder))).json()) as {
    title: string;
    files: string[];
  };
  const fetched = await Promise.all(
    manifest.files.map(async (path) => ({ path, blob: await (await fetchOk(new URL(path, folder))).blob() })),
  );
  return { title: manifest.title, files: fetched };
}

async function fetchOk(url: URL): Promise<Response> {
  const response = await fetch(url);
  if (!response.ok) {
    throw new Error(`${url.pathname}: the site answered ${response.status}. Was the demo folder published?`);
  }
  return response;
}

function freshStage(name: string): StageState {
  return { name, status: "waiting", fraction: 0, seconds: null, counts: {}, warnings: [] };
}

function updateStage(name: string, change: Partial<StageState>): void {
  stages.value = stages.value.map((stage) => (stage.name === name ? { ...stage, ...change } : stage));
}

function mediaType(name: string): string {
  return name.endsWith(".json") ? "application/json" : "application/octet-stream";
}

function say(text: string): void {
  announcement.value = text;
}

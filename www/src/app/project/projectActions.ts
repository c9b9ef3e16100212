/** What a person can do with the project: files, the demo scene, and what is asked for beyond the files. */
import { batch } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import { asTree } from "../../shared/paramTree";
import type { StageName } from "../../shared/stages";
import { counted } from "../parts/counted";
import { saveFile } from "../parts/saveFile";
import type { Turn } from "../session/actionQueue";
import { refusalNotices } from "../session/failureNotice";
import { forgetFlight, planFlight, proposeTiles } from "../session/flightPlanning";
import { showFound } from "../session/foundBefore";
import {
  actions,
  engine,
  ensureInspected,
  ensureScene,
  outdateFiles,
  outdateInspection,
  outdateScene,
  tellParams,
} from "../session/session";
import { changeParams, clearResults, runEverything, runStages, runTo } from "../session/stageRuns";
import { noteStep, type Step, steps, takeStep, UNDO, UNDO_ADDING, undoneSteps } from "../session/steps";
import {
  packResults,
  presentResults,
  showOutdated,
  showStoredResults,
  unpackResults,
} from "../session/storedResults";
import { loadOptions, wishesOf } from "../settings/loadOptions";
import { changedParams, paramsOf } from "../settings/parameterForm";
import { keepResult } from "../state/keptResult";
import { dismissAbout, notify } from "../state/notices";
import { defaults, params, replaceParams } from "../state/parameters";
import {
  files,
  hasPhotographsOnly,
  inspection,
  isModelOnly,
  markAsDemo,
  NO_OPTIONS,
  nameProject,
  type ProjectState,
  presentProject,
  projectName,
  projectStages,
  type RunOptions,
  replaceFiles,
  replaceRunOptions,
  runOptions,
  setInspection,
} from "../state/project";
import { allResults } from "../state/results";
import { clearScene, scene } from "../state/scene";
import { replaceStages, stages } from "../state/stages";
import { showTab, showView, standAt, tab } from "../state/viewState";
import { openPanel } from "../view/screen/panels";
import { placeOf } from "./folders";
import { baseName } from "./inputFiles";
import { forgetStoredProject, readStoredProject, readStoredResults } from "./storedProject";

/** Adds files to the project (the same path replaces), inspects them, and loads the scene once it looks whole. */
export async function addFiles(added: InputFile[]): Promise<void> {
  if (added.length === 0) {
    return;
  }
  await actions.perform({ kind: "change", phase: "load", words: "Reading files" }, async (turn) => {
    await addFilesIn(turn, added);
  });
}

/** The same as part of another action. */
export async function addFilesIn(turn: Turn, added: readonly InputFile[]): Promise<void> {
  const look = presentLook();
  noteStep(`${added.length === 1 ? baseName(added[0]?.path ?? "") : counted(added.length, "files")} added`);
  const byPath = new Map(files.value.map((file) => [file.path, file]));
  for (const file of added) {
    byPath.set(file.path, file);
  }
  if (projectName.value === "") {
    nameProject(nameOf(added));
  }
  if (look.found !== null) {
    openPanel("project");
  }
  setProject([...byPath.values()]);
  if (look.found !== null) {
    offerUndo(UNDO_ADDING, "What they change is outdated: reconstruct again.");
  }
  await loadProject(turn, adoptProject);
  lookAgain(look);
  await adoptResults();
}

/** Begins a new project with these files, in the place of the present one. */
export async function openFiles(added: InputFile[]): Promise<void> {
  if (added.length === 0) {
    return;
  }
  await actions.perform({ kind: "open", phase: "load", words: "Reading files" }, (turn) =>
    openIn(turn, added, nameOf(added)),
  );
}

/** A project has the name of its folder, or of its archive. */
function nameOf(all: readonly InputFile[]): string {
  const [first] = all;
  const relative = first?.blob instanceof File ? first.blob.webkitRelativePath : "";
  const root = (path: string) => (path.includes("/") ? path.slice(0, path.indexOf("/")) : "");
  const isCommon = first !== undefined && all.every(({ path }) => root(path) === root(first.path));
  const archive = all.length === 1 ? (/^(.*)\.zip$/i.exec(baseName(first?.path ?? ""))?.[1] ?? "") : "";
  const folder = first === undefined ? undefined : placeOf(first.blob)?.folder.name;
  return folder || root(relative) || (isCommon && root(first.path)) || archive || "Own files";
}

/** The same as part of another action. */
async function openIn(turn: Turn, next: InputFile[], name: string, id?: number): Promise<void> {
  noteStep(`“${projectName.value}” closed`);
  batch(() => {
    replaceFiles([]);
    nameProject(name, id);
    setProject(next);
  });
  offerUndo();
  await loadProject(turn, adoptProject);
  await adoptResults();
}

/** Takes up what a project file among the added ones asks for. */
async function adoptProject(): Promise<void> {
  const opened = await engine.call("openedProject");
  if (opened === null || inspection.value === null) {
    return;
  }
  const wishes = wishesOf(opened.options, inspection.value);
  batch(() => {
    replaceRunOptions(wishes);
    replaceParams(paramsOf(defaults.value, changedParams(defaults.value, asTree(opened.params))));
    setInspection(null);
  });
  await tellParams(params.value);
  replaceStages(projectStages.value);
  await ensureInspected();
}

/** Shows what a project file was saved with; more files than that one make other results. */
async function adoptResults(): Promise<void> {
  if (files.value.length !== 1 || scene.value === null) {
    return;
  }
  const kept = unpackResults(await engine.call("openedResults"));
  if (kept !== null) {
    showStoredResults(kept);
    showTab(allResults.value.main.glb === null ? "images" : "model");
  }
}

/** Saves files, wishes, parameters and results as one file, which opens to the same state. */
export async function saveProject(): Promise<void> {
  const words = "Writing the project";
  await actions.perform({ kind: "save", name: "project", phase: "save", words }, async () => {
    if (files.value.length === 0) {
      return;
    }
    await ensureInspected();
    await tellParams(params.value);
    const options = loadOptions(runOptions.value, inspection.value);
    const shown = presentResults();
    const packed = shown === null ? new Uint8Array() : packResults(shown);
    const bytes = await engine.call("exportProject", options, packed);
    saveFile("ridgeline-project.zip", new Blob([bytes], { type: "application/zip" }));
  });
}

export async function removeFile(path: string): Promise<void> {
  await actions.perform({ kind: "change", phase: "load", words: "Reading files" }, async (turn) => {
    const left = files.value.filter((file) => file.path !== path);
    // A second click on the same file.
    if (left.length < files.value.length) {
      remove(`${baseName(path)} removed`, left);
      await loadProject(turn);
    }
  });
}

/** Lets go of the project: what comes next is another one. */
export async function clearProject(): Promise<void> {
  await actions.perform({ kind: "open", name: "nothing", phase: "load" }, () => {
    if (files.value.length > 0) {
      batch(() => {
        remove(`“${projectName.value}” closed`, []);
        nameProject("");
      });
    }
  });
}

/** Leaves some of the files, and offers to take that back. */
function remove(what: string, left: InputFile[]): void {
  noteStep(what);
  setProject(left);
  offerUndo();
}

/** Offers to take back the last step, where it is about the project. */
function offerUndo(name = UNDO, text = ""): void {
  const last = steps.value.at(-1);
  if (last?.about === "project") {
    notify({ severity: "info", title: last.what, text, action: { name, run: () => void undo() } });
  }
}

/** Takes back the last step. */
export function undo(): Promise<void> {
  return goTo("undo");
}

/** Does the step again that was taken back last. */
export function redo(): Promise<void> {
  return goTo("redo");
}

async function goTo(way: "undo" | "redo"): Promise<void> {
  const { files: wanted, options } = (way === "undo" ? steps : undoneSteps).value.at(-1)?.state ?? {};
  if (wanted === files.value && JSON.stringify(options) === JSON.stringify(runOptions.value)) {
    await changeBack(takeStep(way));
    return;
  }
  await actions.perform({ kind: "open", phase: "load", words: "Reading files" }, async (turn) => {
    const step = takeStep(way);
    if (step !== null) {
      const restoring = restoreIn(turn, step.state);
      offerUndo();
      await restoring;
      showFound();
    }
    if (allResults.value.main.glb !== null) {
      showTab("model");
    }
  });
}

/** Of parameters nothing has to be read; corrections are applied at once. */
async function changeBack(step: Step | null): Promise<void> {
  if (step !== null) {
    changeParams(step.state.params);
    const last = stages.value.at(-1);
    if (step.about === "corrections" && last !== undefined) {
      await runTo(last.name);
    }
  }
}

/** Opens a project of an earlier visit; nothing happens where the person does not let its folder be read. */
export async function reopen(id: number): Promise<void> {
  const stored = await readStoredProject(id);
  const kept = stored !== null && "unlock" in stored ? await stored.unlock() : stored;
  if (kept !== null) {
    await actions.perform({ kind: "open", phase: "load", words: "Reading files" }, async (turn) => {
      await restoreWithResults(turn, kept);
      if (allResults.value.main.glb !== null) {
        showTab("model");
      }
    });
  }
}

/** Lets go of the project, and of what the browser keeps of it. */
export async function deleteProject(): Promise<void> {
  const { id } = presentProject();
  await clearProject();
  await forgetStoredProject(id);
}

/** Takes up a stored project with what was found of it, as part of another action. */
export async function restoreWithResults(turn: Turn, kept: ProjectState, linked = {}): Promise<void> {
  await restoreIn(turn, kept, linked);
  const found = await readStoredResults();
  turn.signal.throwIfAborted();
  // A model that is there already has been taken up anew.
  if (found !== null && !isModelOnly.value && (scene.value !== null || runOptions.value.tileM !== null)) {
    showStoredResults(found);
  }
}

/** Takes up a project as it was, but for what a link changes. */
async function restoreIn(turn: Turn, kept: ProjectState, linked = {}): Promise<void> {
  batch(() => {
    nameProject(kept.name, kept.id);
    replaceParams(paramsOf(defaults.value, { ...changedParams(defaults.value, kept.params), ...linked }));
    replaceStages(projectStages.value);
    setProject(kept.files);
    replaceRunOptions({ ...NO_OPTIONS, ...kept.options });
    markAsDemo(kept.isDemo);
  });
  await loadProject(turn);
}

/**
 * Fetches the demo scene from this site and opens it as if it were the user's; then runs it up to a stage: the last
 * one unless another is named, none for null.
 */
export async function openDemo(target?: StageName | null): Promise<void> {
  await actions.perform({ kind: "open", name: "demo", phase: "load" }, (turn) => openDemoIn(turn, target));
}

/** However often it is opened, it is kept once. */
const DEMO_ID = 1;

/** The same as part of another action. */
export async function openDemoIn(turn: Turn, target?: StageName | null): Promise<void> {
  turn.enter("load", "Fetching the demo scene");
  const fetched = await fetchDemo(turn.signal);
  turn.signal.throwIfAborted();
  turn.enter("load", "Reading files");
  const opening = openIn(turn, fetched.files, fetched.title, DEMO_ID);
  markAsDemo(true);
  await opening;
  if (target === undefined) {
    await runEverything(turn);
  } else if (target !== null) {
    await runStages(turn, target);
  }
}

/** A change of what is asked for, in the list of steps. */
const OPTION_WORDS: Readonly<Partial<Record<keyof RunOptions, string>>> = {
  orientation: "Another orientation",
  leftOut: "Files left out or taken",
  roi: "Region",
  groundZ: "Height of the ground",
  applyFix: "Mistake in the orientation",
  ignoreCheck: "Orientation check",
  tileM: "Tiles",
  reduction: "Size of the photographs",
  epsg: "Reference system",
};

/** Changes what is asked for beyond the files, and loads the scene again. */
export async function setRunOptions(change: Partial<RunOptions>): Promise<void> {
  await actions.perform({ kind: "change", phase: "load", words: "Loading" }, async (turn) => {
    const look = presentLook();
    const [name = ""] = Object.keys(change);
    noteStep(OPTION_WORDS[name as keyof RunOptions] ?? "Choice changed", "options");
    outdateScene();
    outdateInspection();
    batch(() => {
      replaceRunOptions({ ...runOptions.value, ...change });
      if (change.orientation !== undefined) {
        setInspection(null);
        forgetFlight();
      }
      if (change.tileM === null) {
        forgetFlight();
      }
      dismissAbout("project");
      closeScene();
    });
    await loadProject(turn);
    lookAgain(look);
  });
}

/** What is found and looked at, before the scene is loaded again. */
function presentLook() {
  return { found: presentResults(), tab: tab.value };
}

/** The same afterwards, outdated unless it was found so before. */
function lookAgain(before: ReturnType<typeof presentLook>): void {
  if (!showFound()) {
    showOutdated(before.found);
  }
  if (before.found !== null && scene.value !== null) {
    showTab(before.tab);
  }
}

/** Has other files take the place of the project's. */
function setProject(next: InputFile[]): void {
  outdateFiles();
  batch(() => {
    forgetFlight();
    replaceFiles(next);
    dismissAbout("project");
    closeScene();
  });
}

/** Inspects the files, says what stands against them, or loads the scene. */
async function loadProject(turn: Turn, adopt?: () => Promise<void>): Promise<void> {
  if (files.value.length === 0) {
    return;
  }
  await ensureInspected();
  await adopt?.();
  const problems = inspection.value?.errors ?? [];
  // The inspection is of all images, and does not look into them: where that matters, loading says
  // what is wrong.
  proposeTiles();
  const { leftOut, tileM } = runOptions.value;
  const isFinal = leftOut.length === 0 && inspection.value?.is_implausible !== true;
  if (tileM !== null) {
    // A large area may be too much to load at once: where something stands against the whole, the plan of the tiles says
    // whether it does against them.
    await planFlight(turn, tileM);
    return;
  }
  if (problems.length === 0 || !isFinal) {
    await ensureScene();
    if (isModelOnly.value) {
      await runEverything(turn);
    }
    return;
  }
  // What is missing, and how to come by it, fills the page already.
  const isSaid = hasPhotographsOnly.value && problems.length === 1;
  // Without a photograph all else follows from that.
  const told = inspection.value?.images.length === 0 ? problems.slice(0, 1) : problems;
  for (const notice of isSaid ? [] : refusalNotices(told)) {
    notify(notice);
  }
}

/** Lets go of the scene and of all that was found in it. */
function closeScene(): void {
  clearScene();
  showView(0);
  standAt(null);
  keepResult(null);
  clearResults();
}

async function fetchDemo(signal: AbortSignal): Promise<{ title: string; files: InputFile[] }> {
  const folder = new URL("demo/", document.baseURI);
  const manifest = (await (await fetchOk(new URL("manifest.json", folder), signal)).json()) as {
    title: string;
    files: string[];
  };
  const fetched = await Promise.all(
    manifest.files.map(async (path) => ({
      path,
      blob: await (await fetchOk(new URL(path, folder), signal)).blob(),
    })),
  );
  return { title: manifest.title, files: fetched };
}

async function fetchOk(url: URL, signal: AbortSignal): Promise<Response> {
  const response = await fetch(url, { signal });
  if (!response.ok) {
    throw new Error(`${url.pathname}: the site answered ${response.status}. Was the demo folder published?`);
  }
  return response;
}

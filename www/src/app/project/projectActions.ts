/** What a person can do with the project: files, the demo scene, and what is asked for beyond the files. */
import { batch } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import { asTree } from "../../shared/paramTree";
import type { StageName } from "../../shared/stages";
import { stagesOf } from "../../stages/catalogue";
import { counted } from "../parts/counted";
import { saveFile } from "../parts/saveFile";
import type { Turn } from "../session/actionQueue";
import { refusalNotices } from "../session/failureNotice";
import { forgetFlight, planFlight, proposeTiles } from "../session/flightPlanning";
import { forgetMethods } from "../session/methodResults";
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
import { clearResults, runEverything, runStages, UNDO_ADDING } from "../session/stageRuns";
import {
  packResults,
  presentResults,
  type StoredResults,
  showOutdated,
  showStoredResults,
  unpackResults,
} from "../session/storedResults";
import { linkedParams } from "../settings/addressLink";
import { loadOptions, wishesOf } from "../settings/loadOptions";
import { changedParams, paramsOf } from "../settings/parameterForm";
import { keepResult } from "../state/keptResult";
import { dismissAbout, dismissOffers, notify } from "../state/notices";
import { defaults, method, params, replaceParams } from "../state/parameters";
import {
  files,
  hasPhotographsOnly,
  inspection,
  isDemo,
  markAsDemo,
  NO_OPTIONS,
  nameProject,
  projectName,
  type RunOptions,
  replaceFiles,
  replaceRunOptions,
  runOptions,
  setInspection,
} from "../state/project";
import { allResults } from "../state/results";
import { clearScene, scene } from "../state/scene";
import { replaceStages } from "../state/stages";
import { showTab, showView, standAt, tab } from "../state/viewState";
import { openPanel } from "../view/screen/panels";
import { placeOf } from "./folders";
import { baseName } from "./inputFiles";
import type { StoredProject } from "./storedProject";

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
async function openIn(turn: Turn, next: InputFile[], name: string): Promise<void> {
  noteStep(`“${projectName.value}” closed`);
  replaceFiles([]);
  nameProject(name);
  setProject(next);
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
  await tellParams();
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
    await engine.call("setParams", params.value);
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
      remove(baseName(path), left);
      await loadProject(turn);
    }
  });
}

/** Lets go of the project: what comes next is another one. */
export async function clearProject(): Promise<void> {
  await actions.perform({ kind: "open", name: "nothing", phase: "load" }, () => {
    if (files.value.length > 0) {
      remove(`“${projectName.value}”`, []);
      nameProject("");
    }
  });
}

const UNDO = "Undo";
/** So many steps are kept: each holds what had been found. */
const MOST_STEPS = 8;

/** What was done to the project in this visit, and how it was before that; the last step is taken back first. */
let steps: { what: string; before: StoredProject; found: StoredResults | null }[] = [];

/** Notes the project as it is, before it changes. */
function noteStep(what: string): void {
  if (files.value.length > 0) {
    const before: StoredProject = {
      name: projectName.value,
      isDemo: isDemo.value,
      files: files.value,
      options: runOptions.value,
      params: params.value,
    };
    steps = [...steps, { what, before, found: presentResults() }].slice(-MOST_STEPS);
  }
}

/** Leaves some of the files, and offers to take that back. */
function remove(what: string, left: InputFile[]): void {
  noteStep(`${what} removed`);
  setProject(left);
  offerUndo();
}

/** Offers to take back the last step, in place of any other one. */
function offerUndo(name = UNDO, text = ""): void {
  dismissOffers(UNDO);
  dismissOffers(UNDO_ADDING);
  const last = steps.at(-1);
  if (last !== undefined) {
    notify({ severity: "info", title: last.what, text, action: { name, run: () => void undo() } });
  }
}

/** Takes back the last step. */
export async function undo(): Promise<void> {
  await actions.perform({ kind: "open", phase: "load", words: "Reading files" }, async (turn) => {
    const last = steps.at(-1);
    if (last === undefined) {
      return;
    }
    steps = steps.slice(0, -1);
    await restoreIn(turn, last.before, () => offerUndo());
    if (last.found !== null && scene.value !== null) {
      showStoredResults(last.found);
    }
    if (allResults.value.main.glb !== null) {
      showTab("model");
    }
  });
}

/** Takes up a stored project as part of another action; `shown` happens as soon as its files are there. */
export async function restoreIn(turn: Turn, kept: StoredProject, shown = () => {}): Promise<void> {
  nameProject(kept.name);
  const linked = linkedParams();
  batch(() => {
    replaceParams(paramsOf(defaults.value, { ...changedParams(defaults.value, kept.params), ...linked }));
    replaceStages(stagesOf(method.value));
    setProject(kept.files);
    replaceRunOptions({ ...NO_OPTIONS, ...kept.options });
    markAsDemo(kept.isDemo);
  });
  shown();
  await loadProject(turn);
}

/**
 * Fetches the demo scene from this site and opens it as if it were the user's; then runs it up to a stage: the last
 * one unless another is named, none for null.
 */
export async function openDemo(target?: StageName | null): Promise<void> {
  await actions.perform({ kind: "open", name: "demo", phase: "load" }, (turn) => openDemoIn(turn, target));
}

/** The same as part of another action. */
export async function openDemoIn(turn: Turn, target?: StageName | null): Promise<void> {
  turn.enter("load", "Fetching the demo scene");
  const fetched = await fetchDemo(turn.signal);
  turn.signal.throwIfAborted();
  turn.enter("load", "Reading files");
  const opening = openIn(turn, fetched.files, fetched.title);
  markAsDemo(true);
  await opening;
  if (target === undefined) {
    await runEverything(turn);
  } else if (target !== null) {
    await runStages(turn, target);
  }
}

/** Changes what is asked for beyond the files, and loads the scene again. */
export async function setRunOptions(change: Partial<RunOptions>): Promise<void> {
  await actions.perform({ kind: "change", phase: "load", words: "Loading" }, async (turn) => {
    const look = presentLook();
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

/** The same afterwards, outdated. */
function lookAgain(before: ReturnType<typeof presentLook>): void {
  showOutdated(before.found);
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
    return;
  }
  // What is missing, and how to come by it, fills the page already.
  const isSaid = hasPhotographsOnly.value && problems.length === 1;
  for (const notice of isSaid ? [] : refusalNotices(problems)) {
    notify(notice);
  }
}

/** Lets go of the scene and of all that was found in it. */
function closeScene(): void {
  clearScene();
  showView(0);
  standAt(null);
  keepResult(null);
  forgetMethods();
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

/** What a person can do with the project: files, the demo scene, and what is asked for beyond the files. */
import { batch } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import { asTree } from "../../shared/paramTree";
import type { StageName } from "../../shared/stages";
import { saveFile } from "../parts/saveFile";
import { failureNotice } from "../session/failureNotice";
import {
  engine,
  ensureInspected,
  ensureScene,
  guarded,
  listStages,
  outdateFiles,
  outdateInspection,
  outdateScene,
  stopWorker,
} from "../session/session";
import { clearResults, runAll, runTo } from "../session/stageRuns";
import { linkedParams } from "../settings/addressLink";
import { loadOptions, wishesOf } from "../settings/loadOptions";
import { changedParams, paramsOf } from "../settings/parameterForm";
import { keepResult } from "../state/keptResult";
import { dismissAll, dismissOffers, notify } from "../state/notices";
import { defaults, params, replaceParams } from "../state/parameters";
import {
  files,
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
import { clearScene } from "../state/scene";
import { showView } from "../state/viewState";
import type { StoredProject } from "./storedProject";

/** So many rejections are shown at once: the first ones usually explain the others. */
const MAX_PROBLEMS = 4;

/** Adds files (the same path replaces), inspects them, and loads the scene once it looks whole. */
export async function addFiles(added: InputFile[], name?: string): Promise<void> {
  if (added.length === 0) {
    return;
  }
  removals = [];
  const byPath = new Map(files.value.map((file) => [file.path, file]));
  for (const file of added) {
    byPath.set(file.path, file);
  }
  if (name !== undefined || projectName.value === "") {
    nameProject(name ?? "Own files");
  }
  await setProject([...byPath.values()], adoptProject);
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
  await listStages();
  await ensureInspected();
}

/** Saves files, wishes, parameters and results as one file, which opens to the same state. */
export async function saveProject(): Promise<void> {
  await guarded("Writing the project", async () => {
    await ensureInspected();
    await engine.call("setParams", params.value);
    const options = loadOptions(runOptions.value, inspection.value);
    const bytes = await engine.call("exportProject", options);
    saveFile("ridgeline-project.zip", new Blob([bytes], { type: "application/zip" }));
  });
}

export async function removeFile(path: string): Promise<void> {
  await removing(path.slice(path.lastIndexOf("/") + 1), () =>
    setProject(files.value.filter((file) => file.path !== path)),
  );
}

export async function clearProject(): Promise<void> {
  await removing("The project", async () => {
    nameProject("");
    await setProject([]);
  });
}

const UNDO = "Undo";

/** What was removed since files came last, and the project before that; the last removal is taken back first. */
let removals: { what: string; before: StoredProject }[] = [];

/** Removes something, and offers to take that back. */
async function removing(what: string, remove: () => Promise<void>): Promise<void> {
  const before: StoredProject = {
    name: projectName.value,
    isDemo: isDemo.value,
    files: files.value,
    options: runOptions.value,
    params: params.value,
  };
  removals = [...removals, { what, before }];
  // It is gone at once; reading what is left takes its time.
  const reading = remove();
  offerUndo();
  await reading;
}

/** Offers to take back the last removal, in place of any other one. */
function offerUndo(): void {
  dismissOffers(UNDO);
  const last = removals.at(-1);
  if (last !== undefined) {
    notify({
      severity: "info",
      title: `${last.what} was removed`,
      text: "",
      action: { name: UNDO, run: () => void undo(last.before) },
    });
  }
}

async function undo(before: StoredProject): Promise<void> {
  removals = removals.slice(0, -1);
  await restoreProject(before);
  offerUndo();
}

/** Takes up the project of the last visit. */
export async function restoreProject(kept: StoredProject): Promise<void> {
  nameProject(kept.name);
  replaceRunOptions({ ...NO_OPTIONS, ...kept.options });
  const linked = linkedParams();
  replaceParams(paramsOf(defaults.value, { ...changedParams(defaults.value, kept.params), ...linked }));
  await guarded("", listStages);
  await setProject(kept.files);
  markAsDemo(kept.isDemo);
}

/**
 * Fetches the demo scene from this site and drops it in as if it were the user's; then runs it up to a stage: the last
 * one unless another is named, none for null.
 */
export async function openDemo(target?: StageName | null): Promise<void> {
  const fetched = await guarded("Fetching the demo scene", fetchDemo);
  if (fetched === undefined) {
    return;
  }
  replaceFiles([]);
  await addFiles(fetched.files, fetched.title);
  markAsDemo(true);
  if (target === undefined) {
    await runAll();
  } else if (target !== null) {
    await runTo(target);
  }
}

/** Changes what is asked for beyond the files, and loads the scene again. */
export async function setRunOptions(change: Partial<RunOptions>): Promise<void> {
  stopWorker();
  outdateScene();
  outdateInspection();
  batch(() => {
    replaceRunOptions({ ...runOptions.value, ...change });
    if (change.orientation !== undefined) {
      setInspection(null);
    }
    dismissAll();
    closeScene();
  });
  await loadProject("Loading");
}

async function setProject(next: InputFile[], adopt?: () => Promise<void>): Promise<void> {
  stopWorker();
  outdateFiles();
  batch(() => {
    replaceFiles(next);
    dismissAll();
    closeScene();
  });
  await loadProject("Reading files", adopt);
}

/** Inspects the files, says what stands against them, or loads the scene. */
async function loadProject(what: string, adopt?: () => Promise<void>): Promise<void> {
  if (files.value.length === 0) {
    return;
  }
  await guarded(what, async () => {
    await ensureInspected();
    await adopt?.();
    const problems = inspection.value?.errors ?? [];
    // The inspection is of all images, and does not look into them: where that matters, loading says
    // what is wrong.
    const { leftOut, tileM } = runOptions.value;
    const isFinal = leftOut.length === 0 && inspection.value?.is_implausible !== true;
    if (tileM !== null) {
      // A large area may be too much to load at once: where something stands against the whole, the plan of the tiles says
      // whether it does against them.
      const options = loadOptions(runOptions.value, inspection.value);
      await (problems.length === 0 || engine.call("planTiles", options, tileM));
      return;
    }
    if (problems.length === 0 || !isFinal) {
      await ensureScene();
      return;
    }
    for (const problem of problems.slice(0, MAX_PROBLEMS)) {
      notify(failureNotice(problem, "input"));
    }
  });
}

/** Lets go of the scene and of all that was found in it. */
function closeScene(): void {
  clearScene();
  showView(0);
  keepResult(null);
  clearResults();
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

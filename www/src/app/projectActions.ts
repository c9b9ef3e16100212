/** What a person can do with the project: files, the demo scene, and what is asked for beyond the files. */
import { batch } from "@preact/signals";
import type { InputFile } from "../shared/messages";
import { ensureInspected, ensureScene, guarded, held, listStages, notify, stopWorker } from "./core";
import type { Kept } from "./keep";
import { linkedParams } from "./link";
import { failureNotice } from "./notices";
import { changedParams, paramsOf } from "./paramForm";
import { clearResults, runAll, runTo } from "./running";
import {
  defaults,
  files,
  freshStages,
  images,
  inspection,
  isDemo,
  keptResult,
  NO_OPTIONS,
  notices,
  params,
  projectName,
  type RunOptions,
  runOptions,
  scene,
  shownView,
} from "./state";

/** So many refusals are shown at once: the first ones usually explain the others. */
const MAX_PROBLEMS = 4;

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

/** Changes what is asked for beyond the files, and loads the scene again. */
export async function setRunOptions(change: Partial<RunOptions>): Promise<void> {
  stopWorker();
  held.scene = false;
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

async function setProject(next: InputFile[]): Promise<void> {
  stopWorker();
  held.files = false;
  held.scene = false;
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

/** Which scene the lessons' real figures show: the project that is open in this browser, files, a link, or the demo. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { counted } from "../../app/parts/counted";
import { droppedFiles } from "../../app/project/inputFiles";
import { type LockedProject, readStoredProject } from "../../app/project/storedProject";
import { loadOptions } from "../../app/settings/loadOptions";
import type { ProjectState } from "../../app/state/project";
import { keepScenes, type SceneInput } from "../../element/sharedScene";
import type { InputFile } from "../../shared/calls";

export type Choice =
  | { kind: "demo" }
  | { kind: "link"; url: string }
  | { kind: "files"; name: string; input: SceneInput };

const chosen = signal<Choice | null>(null);
const stored = signal<{ name: string; input: SceneInput } | null>(null);
const lockedProject = signal<LockedProject | null>(null);

/** The scene that is shown; null until it is known whether a project is kept. */
export const choice: ReadonlySignal<Choice | null> = chosen;
/** A project whose folder the browser reads again only when it is asked. */
export const locked: ReadonlySignal<LockedProject | null> = lockedProject;
export const hasStored: ReadonlySignal<boolean> = computed(() => stored.value !== null);

/** In words, for the line that says so. */
export const choiceName: ReadonlySignal<string> = computed(() => {
  const now = chosen.value;
  return now === null || now.kind === "demo" ? "the demo scene" : now.kind === "link" ? now.url : now.name;
});

/** Looks for the project of this browser, unless a link names a scene. */
export async function beginWith(url: string | null): Promise<void> {
  const kept = await readStoredProject();
  if (kept !== null && "unlock" in kept) {
    lockedProject.value = kept;
  } else if (kept !== null && !kept.isDemo && kept.files.length > 0) {
    stored.value = { name: kept.name || "your project", input: inputOf(kept) };
  }
  if (url !== null) {
    choose({ kind: "link", url });
  } else if (!showStored()) {
    choose({ kind: "demo" });
  }
}

/** Shows the kept project; false where there is none. */
export function showStored(): boolean {
  const own = stored.value;
  if (own !== null) {
    choose({ kind: "files", ...own });
  }
  return own !== null;
}

export async function unlockStored(): Promise<void> {
  const kept = await lockedProject.peek()?.unlock();
  if (kept != null) {
    lockedProject.value = null;
    stored.value = { name: kept.name || "your project", input: inputOf(kept) };
    showStored();
  }
}

export function showDemo(): void {
  choose({ kind: "demo" });
}

export function showFiles(files: readonly InputFile[]): void {
  const first = files[0];
  if (first !== undefined) {
    const name = files.length === 1 ? first.path : counted(files.length, "files");
    choose({ kind: "files", name, input: { files } });
  }
}

/** Files that are dropped anywhere on the lessons are their scene from then on. */
export function followDrops(): void {
  window.addEventListener("dragover", (event) => event.preventDefault());
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    if (event.dataTransfer !== null) {
      void droppedFiles(event.dataTransfer).then(showFiles);
    }
  });
}

function choose(to: Choice): void {
  // The scenes of the old choice end with their last figure.
  keepScenes(false);
  chosen.value = to;
  keepScenes(true);
}

function inputOf({ files, options, params }: ProjectState): SceneInput {
  return {
    files,
    ...(Object.keys(params).length > 0 && { params }),
    options: async (engine) =>
      loadOptions(options, options.leftOut.length > 0 ? await engine.call("inspect", {}) : null),
  };
}

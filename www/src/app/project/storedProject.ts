/** The last projects, kept in this browser (IndexedDB): files, options, parameters, and what was found with them. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import { presentResults, type StoredResults } from "../session/storedResults";
import { isBusy } from "../state/activity";
import { defaults } from "../state/parameters";
import { files, type ProjectState, presentProject, runOptions } from "../state/project";
import { askToRead, fileAt, isReadable, placeOf } from "./folders";
import { storeOf } from "./tiles/database";
import { forgetKeptTiles } from "./tiles/keptTiles";

/** The projects that are kept, each by its number: files, options and parameters, and results. */
const request = storeOf("ridgeline", "project", 2);
/** The number of the project that was open last. */
const PRESENT = "present";
type Part = "project" | "files" | "results";
const keyOf = (id: number, part: Part): IDBValidKey => [id, part];

/** So many are kept; beyond them the one that was open longest ago is deleted. */
const MOST_PROJECTS = 5;

interface Kept extends Omit<ProjectState, "files"> {
  /** When it was open last, milliseconds since 1970. */
  seen: number;
}

const listed = signal<readonly Kept[]>([]);
/** What is kept, the last one first; known once it has been listed. */
export const keptProjects: ReadonlySignal<readonly Kept[]> = listed;

/** A file as it is kept: the folder that it lies in, where the browser can read that again, or a copy. */
type StoredFile = { path: string; size: number } & (
  | { blob: Blob }
  | { folder: FileSystemDirectoryHandle; within: string }
);

/** A project whose files lie in a folder that the browser reads only when the person allows it again. */
export interface LockedProject {
  name: string;
  /** Asks the person; null where that is declined. Only as the answer to a click. */
  unlock(): Promise<ProjectState | null>;
}

const written = signal<number | null>(null);
/** Bytes that the browser keeps of the project; null when it keeps nothing. */
export const storedBytes: ReadonlySignal<number | null> = written;

/** So long after a change the project is written, milliseconds. */
const DELAY_MS = 400;

/** A project that is kept, or that of the last visit; null where there is none, or storage is forbidden. */
export async function readStoredProject(asked?: number): Promise<ProjectState | LockedProject | null> {
  try {
    const id = asked ?? (await read<number>(PRESENT));
    const kept = id === undefined ? undefined : await read<Kept>(keyOf(id, "project"));
    const stored = id === undefined ? undefined : await read<StoredFile[]>(keyOf(id, "files"));
    if (kept === undefined || stored === undefined) {
      return null;
    }
    const folders = new Set(stored.flatMap((file) => ("folder" in file ? [file.folder] : [])));
    const readable = await Promise.all([...folders].map(isReadable));
    if (readable.every((is) => is)) {
      return { ...kept, files: await opened(stored) };
    }
    return {
      name: kept.name,
      unlock: async () => {
        const allowed = await Promise.all([...folders].map(askToRead));
        return allowed.every((is) => is) ? { ...kept, files: await opened(stored) } : null;
      },
    };
  } catch {
    return null;
  }
}

async function opened(stored: readonly StoredFile[]): Promise<InputFile[]> {
  const found = await Promise.all(
    stored.map(async (file) => {
      const blob = "blob" in file ? file.blob : await fileAt({ folder: file.folder, path: file.within });
      return blob === null ? [] : [{ path: file.path, blob }];
    }),
  );
  return found.flat();
}

function storedFile({ path, blob }: InputFile): StoredFile {
  const place = placeOf(blob);
  return place === undefined
    ? { path, size: blob.size, blob }
    : { path, size: blob.size, folder: place.folder, within: place.path };
}

/** What was found of the present project in the last visit; null where there is nothing. */
export async function readStoredResults(): Promise<StoredResults | null> {
  try {
    const { id } = presentProject();
    const kept = await read<{ of: string; found: StoredResults }>(keyOf(id, "results"));
    return kept?.of === presentInput() ? kept.found : null;
  } catch {
    return null;
  }
}

/** By what the results of other files or wishes are told from those of the present ones. */
function presentInput(): string {
  return JSON.stringify([files.value.map(({ path, blob }) => [path, blob.size]), runOptions.value]);
}

/** Looks what is kept. */
export async function listKept(): Promise<void> {
  const keys = await request<IDBValidKey[]>("readonly", (store) => store.getAllKeys()).catch(() => []);
  const ids = keys.flatMap((key) => (Array.isArray(key) && key[1] === "project" ? [Number(key[0])] : []));
  const all = await Promise.all(ids.map((id) => read<Kept>(keyOf(id, "project")).catch(() => undefined)));
  listed.value = all.filter((one) => one !== undefined).sort((a, b) => b.seen - a.seen);
}

/** Forgets a project, and the tiles that are done of the last one. */
export async function forgetStoredProject(id: number): Promise<void> {
  await inTurn(async () => {
    writtenFiles = null;
    forgotten.add(id);
    await forgetOne(id).catch(() => undefined);
    await request("readwrite", (store) => store.delete(PRESENT)).catch(() => undefined);
    await forgetKeptTiles();
    written.value = null;
    await listKept();
  });
}

/** All parts of it: lists are ordered by their members, and come after numbers and words. */
async function forgetOne(id: number): Promise<void> {
  await request("readwrite", (store) => store.delete(IDBKeyRange.bound([id], [id, []])));
}

/** What was found of these a little while ago is not written any more. */
const forgotten = new Set<number>();

/** All that is written and forgotten, one after the other. */
let lastWrite: Promise<void> = Promise.resolve();

function inTurn(act: () => Promise<void>): Promise<void> {
  lastWrite = lastWrite.then(act);
  return lastWrite;
}

/**
 * Writes the last of several changes a little after the first, however many follow, and at once where those that follow are of
 * another project.
 */
function writer<T>(act: (id: number, what: T) => Promise<void>): (what: T) => void {
  let waiting: { id: number; what: T } | null = null;
  const write = () => {
    if (waiting !== null) {
      const { id, what } = waiting;
      waiting = null;
      void inTurn(() => act(id, what));
    }
  };
  return (what) => {
    const { id } = presentProject();
    if (waiting?.id !== id) {
      write();
      window.setTimeout(write, DELAY_MS);
    }
    waiting = { id, what };
  };
}

/** Writes the project whenever it changes. */
export function storeProject(): void {
  const later = writer(write);
  effect(() => {
    const kept = presentProject();
    if (Object.keys(defaults.value).length > 0) {
      later(kept);
    }
  });
}

/** Writes the results whenever there are others and nothing is going on. */
export function storeResults(): void {
  const later = writer(writeResults);
  effect(() => {
    const found = presentResults();
    if (!isBusy.value && files.value.length > 0) {
      later({ of: presentInput(), found });
    }
  });
}

async function writeResults(id: number, kept: { of: string; found: StoredResults | null }): Promise<void> {
  if (forgotten.has(id)) {
    return;
  }
  try {
    const key = keyOf(id, "results");
    await request("readwrite", (store) => (kept.found === null ? store.delete(key) : store.put(kept, key)));
  } catch {
    // They are computed again.
  }
}

/** The files that are written already: a copy of a flight takes its time. */
let writtenFiles: readonly InputFile[] | null = null;

async function write(_: number, { files: all, ...project }: ProjectState): Promise<void> {
  try {
    if (all.length === 0) {
      // At the beginning of a visit nothing has been closed.
      if (writtenFiles !== null) {
        await request("readwrite", (store) => store.delete(PRESENT));
      }
      return;
    }
    forgotten.delete(project.id);
    if (writtenFiles !== all) {
      await request("readwrite", (store) => store.put(all.map(storedFile), keyOf(project.id, "files")));
      writtenFiles = all;
    }
    const kept: Kept = { ...project, seen: Date.now() };
    await request("readwrite", (store) => store.put(kept, keyOf(project.id, "project")));
    await request("readwrite", (store) => store.put(project.id, PRESENT));
    const copied = all.filter(({ blob }) => placeOf(blob) === undefined);
    written.value = copied.reduce((sum, { blob }) => sum + blob.size, 0);
    await listKept();
    for (const { id } of listed.value.slice(MOST_PROJECTS)) {
      await forgetOne(id);
    }
  } catch {
    // Private windows and full disks: the project lasts until the page is closed.
    written.value = null;
  }
}

async function read<T>(key: IDBValidKey): Promise<T | undefined> {
  return request<T | undefined>("readonly", (store) => store.get(key));
}

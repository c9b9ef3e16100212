/** The project kept in this browser (IndexedDB) over reloads: files, options, parameters, and what was found with them. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import type { ParamTree } from "../../shared/paramTree";
import { presentResults, type StoredResults } from "../session/storedResults";
import { isBusy } from "../state/activity";
import { defaults, params } from "../state/parameters";
import { files, isDemo, projectName, type RunOptions, runOptions } from "../state/project";
import { askToRead, fileAt, isReadable, placeOf } from "./folders";
import { forgetKeptTiles } from "./tiles/keptTiles";

export interface StoredProject {
  name: string;
  isDemo: boolean;
  files: InputFile[];
  options: RunOptions;
  params: ParamTree;
}

const DATABASE = "ridgeline";
const STORE = "project";
const KEY = "present";
const FILES_KEY = "files";
const RESULTS_KEY = "results";

/** A file as it is kept: the folder that it lies in, where the browser can read that again, or a copy. */
type StoredFile = { path: string; size: number } & (
  | { blob: Blob }
  | { folder: FileSystemDirectoryHandle; within: string }
);

/** A project whose files lie in a folder that the browser reads only when the person allows it again. */
export interface LockedProject {
  name: string;
  folder: string;
  /** Asks the person; null where that is declined. Only as the answer to a click. */
  unlock(): Promise<StoredProject | null>;
}

const written = signal<number | null>(null);
/** Bytes that the browser keeps of the project; null when it keeps nothing. */
export const storedBytes: ReadonlySignal<number | null> = written;

/** So long after the last change the project is written, milliseconds. */
const DELAY_MS = 400;

/** The project of the last visit; null where there is none, or storage is forbidden. */
export async function readStoredProject(): Promise<StoredProject | LockedProject | null> {
  try {
    const kept = await request<Omit<StoredProject, "files"> | undefined>("readonly", (store) =>
      store.get(KEY),
    );
    const stored = await request<StoredFile[] | undefined>("readonly", (store) => store.get(FILES_KEY));
    if (kept === undefined || stored === undefined) {
      return null;
    }
    const folders = new Set(stored.flatMap((file) => ("folder" in file ? [file.folder] : [])));
    const readable = await Promise.all([...folders].map(isReadable));
    if (readable.every((is) => is)) {
      return { ...kept, files: await opened(stored) };
    }
    isLocked = true;
    return {
      name: kept.name,
      folder: [...folders].map(({ name }) => name).join(", "),
      unlock: async () => {
        const allowed = await Promise.all([...folders].map(askToRead));
        return allowed.every((is) => is) ? { ...kept, files: await opened(stored) } : null;
      },
    };
  } catch {
    return null;
  }
}

/** Until the person has allowed or opened something, nothing of what is kept is replaced. */
let isLocked = false;

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
    const get = (store: IDBObjectStore) => store.get(RESULTS_KEY);
    const kept = await request<{ of: string; found: StoredResults } | undefined>("readonly", get);
    return kept?.of === presentInput() ? kept.found : null;
  } catch {
    return null;
  }
}

/** By what the results of other files or wishes are told from those of the present ones. */
function presentInput(): string {
  return JSON.stringify([files.value.map(({ path, blob }) => [path, blob.size]), runOptions.value]);
}

export async function forgetStoredProject(): Promise<void> {
  try {
    writtenFiles = null;
    await request("readwrite", (store) => store.clear());
    await forgetKeptTiles();
  } catch {
    // Nothing was kept.
  }
  written.value = null;
}

/** Writes the project whenever it changes. */
export function storeProject(): void {
  let timer = 0;
  effect(() => {
    const kept: StoredProject = {
      name: projectName.value,
      isDemo: isDemo.value,
      files: files.value,
      options: runOptions.value,
      params: params.value,
    };
    if (Object.keys(defaults.value).length > 0) {
      clearTimeout(timer);
      timer = window.setTimeout(() => void write(kept), DELAY_MS);
    }
  });
}

/** Writes the results whenever there are others and nothing is going on. */
export function storeResults(): void {
  let timer = 0;
  effect(() => {
    const found = presentResults();
    clearTimeout(timer);
    if (!isBusy.value && files.value.length > 0) {
      const kept = { of: presentInput(), found };
      timer = window.setTimeout(() => void writeResults(kept), DELAY_MS);
    }
  });
}

async function writeResults(kept: { of: string; found: StoredResults | null }): Promise<void> {
  try {
    const isSome = kept.found !== null;
    await request("readwrite", (store) =>
      isSome ? store.put(kept, RESULTS_KEY) : store.delete(RESULTS_KEY),
    );
  } catch {
    // They are computed again.
  }
}

/** The files that are written already: a copy of a flight takes its time. */
let writtenFiles: readonly InputFile[] | null = null;

async function write({ files: all, ...kept }: StoredProject): Promise<void> {
  if (all.length === 0) {
    if (!isLocked) {
      await forgetStoredProject();
    }
    return;
  }
  isLocked = false;
  try {
    if (writtenFiles !== all) {
      await request("readwrite", (store) => store.put(all.map(storedFile), FILES_KEY));
      writtenFiles = all;
    }
    await request("readwrite", (store) => store.put(kept, KEY));
    const copied = all.filter(({ blob }) => placeOf(blob) === undefined);
    written.value = copied.reduce((sum, { blob }) => sum + blob.size, 0);
  } catch {
    // Private windows and full disks: the project lasts until the page is closed.
    written.value = null;
  }
}

function request<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest): Promise<T> {
  return new Promise((resolve, reject) => {
    const opening = indexedDB.open(DATABASE, 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
    opening.onerror = () => reject(opening.error);
    opening.onsuccess = () => {
      const database = opening.result;
      const transaction = database.transaction(STORE, mode);
      const acting = act(transaction.objectStore(STORE));
      transaction.oncomplete = () => {
        database.close();
        resolve(acting.result as T);
      };
      transaction.onerror = () => {
        database.close();
        reject(transaction.error);
      };
      transaction.onabort = transaction.onerror;
    };
  });
}

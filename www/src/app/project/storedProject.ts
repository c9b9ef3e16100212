/** The project kept in this browser (IndexedDB) over reloads: files, options, parameters, and what was found with them. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import type { ParamTree } from "../../shared/paramTree";
import { isBusy } from "../state/activity";
import { defaults, params } from "../state/parameters";
import { files, isDemo, projectName, type RunOptions, runOptions } from "../state/project";
import { presentResults, type StoredResults } from "./storedResults";

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
const RESULTS_KEY = "results";
const written = signal<number | null>(null);
/** Bytes that the browser keeps of the project; null when it keeps nothing. */
export const storedBytes: ReadonlySignal<number | null> = written;

/** So long after the last change the project is written, milliseconds. */
const DELAY_MS = 400;

/** The project of the last visit; null where there is none, or storage is forbidden. */
export async function readStoredProject(): Promise<StoredProject | null> {
  try {
    const kept = await request<StoredProject | undefined>("readonly", (store) => store.get(KEY));
    return kept ?? null;
  } catch {
    return null;
  }
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
    await request("readwrite", (store) => store.clear());
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

async function write(kept: StoredProject): Promise<void> {
  if (kept.files.length === 0) {
    await forgetStoredProject();
    return;
  }
  try {
    await request("readwrite", (store) => store.put(kept, KEY));
    written.value = kept.files.reduce((sum, { blob }) => sum + blob.size, 0);
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

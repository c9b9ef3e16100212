/** The project kept in this browser (IndexedDB) over reloads: files, options and parameters; results are computed again. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import type { ParamTree } from "../../shared/paramTree";
import { defaults, params } from "../state/parameters";
import { files, isDemo, projectName, type RunOptions, runOptions } from "../state/project";

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

export async function forgetStoredProject(): Promise<void> {
  try {
    await request("readwrite", (store) => store.delete(KEY));
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

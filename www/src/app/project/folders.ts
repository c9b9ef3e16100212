/**
 * Folders that the browser reads again after a reload (File System Access): of such files the page keeps the folder and
 * the path, and not a copy.
 */
import type { InputFile } from "../../shared/calls";

interface Place {
  folder: FileSystemDirectoryHandle;
  path: string;
}

const places = new WeakMap<Blob, Place>();

/** Where a file lies, if it came from such a folder. */
export function placeOf(blob: Blob): Place | undefined {
  return places.get(blob);
}

/** What the types of the browser do not know yet. */
interface Permitted {
  queryPermission?(wanted: { mode: "read" }): Promise<PermissionState>;
  requestPermission?(wanted: { mode: "read" }): Promise<PermissionState>;
}

type Picker = (wanted: { id: string; mode: "read" }) => Promise<FileSystemDirectoryHandle>;

function picker(): Picker | undefined {
  return (window as unknown as { showDirectoryPicker?: Picker }).showDirectoryPicker;
}

export function hasFolderPicker(): boolean {
  return picker() !== undefined;
}

/** The files of a folder that the person picks; null where none was picked. */
export async function pickFolder(): Promise<InputFile[] | null> {
  try {
    const folder = await picker()?.call(window, { id: "ridgeline", mode: "read" });
    return folder === undefined ? null : await filesIn(folder);
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") {
      return null;
    }
    throw error;
  }
}

/** All files below a folder, hidden ones left out. */
export async function filesIn(folder: FileSystemDirectoryHandle): Promise<InputFile[]> {
  const found: InputFile[] = [];
  const walk = async (handle: FileSystemDirectoryHandle, above: string): Promise<void> => {
    const entries = handle as unknown as { values(): AsyncIterable<FileSystemHandle> };
    for await (const entry of entries.values()) {
      const path = `${above}${entry.name}`;
      if (entry.name.startsWith(".") || entry.name === "__MACOSX") {
        continue;
      }
      if (entry.kind === "directory") {
        await walk(entry as FileSystemDirectoryHandle, `${path}/`);
      } else {
        const blob = await (entry as FileSystemFileHandle).getFile();
        places.set(blob, { folder, path });
        found.push({ path, blob });
      }
    }
  };
  await walk(folder, "");
  return found.sort((a, b) => (a.path < b.path ? -1 : 1));
}

/** May the folder be read without asking? */
export async function isReadable(folder: FileSystemDirectoryHandle): Promise<boolean> {
  const { queryPermission } = folder as Permitted;
  return (
    queryPermission === undefined || (await queryPermission.call(folder, { mode: "read" })) === "granted"
  );
}

/** Asks the person; only as the answer to a click. */
export async function askToRead(folder: FileSystemDirectoryHandle): Promise<boolean> {
  const { requestPermission } = folder as Permitted;
  return (
    requestPermission === undefined || (await requestPermission.call(folder, { mode: "read" })) === "granted"
  );
}

/** The file at a place of a folder; null where it is no longer there. */
export async function fileAt({ folder, path }: Place): Promise<Blob | null> {
  try {
    const names = path.split("/");
    let within = folder;
    for (const name of names.slice(0, -1)) {
      within = await within.getDirectoryHandle(name);
    }
    const blob = await (await within.getFileHandle(names.at(-1) ?? "")).getFile();
    places.set(blob, { folder, path });
    return blob;
  } catch {
    return null;
  }
}

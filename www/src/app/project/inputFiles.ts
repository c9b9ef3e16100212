/** Files from a drop, a folder or a picker, with their paths, hidden files left out. */
import type { InputFile } from "../../shared/calls";
import { filesIn } from "./folders";

/** Everything that was dropped, folders walked through. Must be called before the event's handler returns. */
export function droppedFiles(transfer: DataTransfer): Promise<InputFile[]> {
  // A folder that can be read again after a reload is not copied into the browser's storage.
  const handles = [...transfer.items].map((item) => {
    const { getAsFileSystemHandle: get } = item as {
      getAsFileSystemHandle?: () => Promise<FileSystemHandle | null>;
    };
    return item.webkitGetAsEntry()?.isDirectory === true ? get?.call(item) : undefined;
  });
  const entries = [...transfer.items]
    .map((item) => item.webkitGetAsEntry())
    .filter((entry) => entry !== null);
  if (entries.length === 0) {
    return Promise.resolve(pickedFiles(transfer.files));
  }
  // Entries are gone once the event is over: they are walked either way.
  const walked = Promise.all(entries.map(walk)).then((lists) => lists.flat().filter(isVisible));
  const [only] = handles;
  return handles.length === 1 && only !== undefined
    ? only.then(
        (handle) => (handle === null ? walked : filesIn(handle as FileSystemDirectoryHandle)),
        () => walked,
      )
    : walked;
}

export function pickedFiles(list: FileList): InputFile[] {
  return [...list]
    .map((file) => ({ path: withoutRoot(file.webkitRelativePath) || file.name, blob: file }))
    .filter(isVisible);
}

async function walk(entry: FileSystemEntry): Promise<InputFile[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) =>
      (entry as FileSystemFileEntry).file(resolve, reject),
    );
    return [{ path: entry.fullPath.replace(/^\//, ""), blob: file }];
  }
  const children = await readAll((entry as FileSystemDirectoryEntry).createReader());
  return (await Promise.all(children.map(walk))).flat();
}

/** The last part of a path. */
export function baseName(path: string): string {
  return path.slice(path.lastIndexOf("/") + 1);
}

/** A directory reader gives its entries in batches, until an empty one. */
async function readAll(reader: FileSystemDirectoryReader): Promise<FileSystemEntry[]> {
  const all: FileSystemEntry[] = [];
  for (;;) {
    const batch = await new Promise<FileSystemEntry[]>((resolve, reject) =>
      reader.readEntries(resolve, reject),
    );
    if (batch.length === 0) {
      return all;
    }
    all.push(...batch);
  }
}

/** The picked folder itself is not part of the paths below it. */
function withoutRoot(path: string): string {
  return path.slice(path.indexOf("/") + 1);
}

function isVisible({ path }: InputFile): boolean {
  return !path.split("/").some((part) => part.startsWith(".") || part === "__MACOSX");
}

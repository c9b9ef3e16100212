/** The project's files in the worker: of large photographs the first bytes, until a call needs their pixels. */
import type { InputFile } from "../shared/calls";
import type { CoreSession } from "./coreSession";

/** The headers of most photographs fit into the first of these; what has its own behind all of them is read whole. */
const HEAD_BYTES = [64 * 1024, 512 * 1024, 2 * 1024 * 1024];

export class ProjectFiles {
  readonly #session: CoreSession;
  #blobs = new Map<string, Blob>();

  constructor(session: CoreSession) {
    this.#session = session;
  }

  /** Has these files take the place of all others. */
  async replace(files: readonly InputFile[]): Promise<void> {
    this.#session.clearFiles();
    this.#blobs = new Map(files.map(({ path, blob }) => [path.replaceAll("\\", "/"), blob]));
    for (const { path, blob } of files) {
      if (!(await this.#addHead(path, blob))) {
        this.#session.addFile(path, new Uint8Array(await readBlob(path, blob)));
      }
    }
  }

  /** Calls the core while it holds the photographs that `needed` names step by step, and takes them from it again. */
  async withWhole<T>(needed: readonly (() => string[])[], call: () => T): Promise<T> {
    try {
      for (const step of needed) {
        for (const path of step()) {
          const blob = this.#blobs.get(path);
          if (blob !== undefined) {
            this.#session.fillFile(path, new Uint8Array(await readBlob(path, blob)));
          }
        }
      }
      return call();
    } finally {
      this.#session.emptyFiles();
    }
  }

  async #addHead(path: string, blob: Blob): Promise<boolean> {
    for (const size of HEAD_BYTES) {
      if (blob.size <= size) {
        return false;
      }
      const head = new Uint8Array(await readBlob(path, blob.slice(0, size)));
      if (!isPhotograph(head)) {
        return false;
      }
      if (this.#session.addHead(path, head, blob.size)) {
        return true;
      }
    }
    return false;
  }
}

/** A JPEG or a PNG, by its first bytes: others say what they are anywhere. */
function isPhotograph([first, second]: Uint8Array): boolean {
  return (first === 0xff && second === 0xd8) || (first === 0x89 && second === 0x50);
}

/** A file may have vanished since it was dropped: the browser's own message does not name it. */
export async function readBlob(path: string, blob: Blob): Promise<ArrayBuffer> {
  try {
    return await blob.arrayBuffer();
  } catch {
    throw new Error(`${path}: the file can no longer be read. Was it moved or changed? Add it again.`);
  }
}

/** The project's files in the worker: of large photographs the head, until a call needs their pixels. */
import type { InputFile } from "../shared/calls";
import type { LackingFile } from "../shared/records";
import type { CoreSession } from "./coreSession";

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

  /** Calls the core while it holds what `needed` names of photographs step by step, and takes it from it again. */
  async withFilled<T>(needed: readonly (() => LackingFile[])[], call: () => T): Promise<T> {
    try {
      for (const step of needed) {
        for (const lacking of step()) {
          await this.#fill(lacking);
        }
      }
      return call();
    } finally {
      this.#session.emptyFiles();
    }
  }

  async #fill({ path, places }: LackingFile): Promise<void> {
    const blob = this.#blobs.get(path);
    if (blob === undefined) {
      return;
    }
    if (places === null) {
      this.#session.fillFile(path, new Uint8Array(await readBlob(path, blob)));
      return;
    }
    // A blob of slices is read at once.
    const starts = places.filter((_, i) => i % 2 === 0);
    const slices = new Blob(starts.map((start, i) => blob.slice(start, places[2 * i + 1])));
    this.#session.fillRanges(path, new Float64Array(places), new Uint8Array(await readBlob(path, slices)));
  }

  /** Adds a photograph by the ranges of it that the core asks for; false where it wants the whole file. */
  async #addHead(path: string, blob: Blob): Promise<boolean> {
    let next = this.#session.addHead(path, blob.size);
    while (typeof next !== "boolean") {
      const range = new Uint8Array(await readBlob(path, blob.slice(...next)));
      next = this.#session.addHead(path, blob.size, range);
    }
    return next;
  }
}

/** A file may have vanished since it was dropped: the browser's own message does not name it. */
export async function readBlob(path: string, blob: Blob): Promise<ArrayBuffer> {
  try {
    return await blob.arrayBuffer();
  } catch {
    throw new Error(`${path}: the file can no longer be read. Was it moved or changed? Add it again.`);
  }
}

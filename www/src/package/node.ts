/** `import { createWorker, readScene } from "ridgeline"` in Node. */
import { readdir, readFile } from "node:fs/promises";
import { join, relative, sep } from "node:path";
import { Worker } from "node:worker_threads";
import { clientOf, type Reply, type RidgelineWorker, type SceneFile } from "./client.js";

export * from "./client.js";

/** A worker thread with its own core. */
export function createWorker(): RidgelineWorker {
  return clientOf((onReply, onFailure) => {
    // Flags of the program (--input-type, --inspect ...) are not meant for the worker.
    const worker = new Worker(new URL("./nodeWorker.js", import.meta.url), { execArgv: [] });
    worker.on("message", (reply: Reply) => onReply(reply));
    worker.on("error", onFailure);
    // A worker without work does not keep the program running.
    worker.unref();
    return {
      post: (request) => {
        worker.ref();
        worker.postMessage(request);
      },
      rest: () => worker.unref(),
      terminate: () => void worker.terminate(),
    };
  });
}

/** All files below a folder. */
export async function readScene(folder: string): Promise<SceneFile[]> {
  const entries = await readdir(folder, { recursive: true, withFileTypes: true });
  const files = entries.filter((entry) => entry.isFile()).map((entry) => join(entry.parentPath, entry.name));
  return Promise.all(
    files.sort().map(async (file) => ({
      path: relative(folder, file).split(sep).join("/"),
      bytes: new Uint8Array(await readFile(file)),
    })),
  );
}

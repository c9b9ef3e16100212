/** `import { createWorker } from "ridgeline"` in a browser. */
import { clientOf, type Reply, type RidgelineWorker } from "./client.js";

export * from "./client.js";

/** A web worker with its own core; its wasm is fetched beside this module. */
export function createWorker(): RidgelineWorker {
  return clientOf((onReply, onFailure) => {
    const worker = new Worker(new URL("./browserWorker.js", import.meta.url), { type: "module" });
    worker.onmessage = (event: MessageEvent<Reply>) => onReply(event.data);
    worker.onerror = (event) => onFailure(new Error(event.message || "The worker could not be started."));
    return {
      post: (request) => worker.postMessage(request),
      rest: () => {},
      terminate: () => worker.terminate(),
    };
  });
}

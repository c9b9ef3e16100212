/** The worker: one wasm instance with one Session. Requests are answered one after the other. */
/// <reference lib="webworker" />
import init, { Session } from "../pkg/ridgeline.js";
import type { WorkerCalls } from "../shared/calls";
import type { Reply, Request } from "../shared/messages";
import { type Answer, answer } from "./answering";
import { workerCalls } from "./calls";
import type { CoreSession } from "./coreSession";
import { serve } from "./serve";

declare const self: DedicatedWorkerGlobalScope;

let core: { session: CoreSession; own: WorkerCalls } | undefined;
serve<Request>(perform, post);

async function perform(request: Request): Promise<Answer> {
  if (request.type === "open") {
    await init({ module_or_path: request.wasmUrl });
    const session = new Session();
    const onProgress = (stage: string, fraction: number) => post({ type: "progress", stage, fraction });
    core = { session, own: workerCalls(session, () => Session.defaultParams(), onProgress) };
    return { result: undefined, transfer: [] };
  }
  if (core === undefined) {
    throw new Error("The reconstruction core is not ready. Reload the page.");
  }
  return answer(core.own, core.session, request);
}

function post(reply: Reply, transfer: Transferable[] = []): void {
  self.postMessage(reply, transfer);
}

/** The worker: one wasm instance with one Session. Requests are answered one after the other. */
/// <reference lib="webworker" />
import init, { Session } from "../pkg/ridgeline.js";
import type { WorkerCalls } from "../shared/calls";
import type { Failure, Reply, Request } from "../shared/messages";
import type { AgreementReport } from "../shared/records";
import { type Answer, answer, type CoreSession, workerCalls } from "./calls";

declare const self: DedicatedWorkerGlobalScope;

let core: { session: CoreSession; own: WorkerCalls } | undefined;
let queue: Promise<void> = Promise.resolve();

self.onmessage = (event: MessageEvent<Request>) => {
  queue = queue.then(() => reply(event.data));
};

async function reply(request: Request): Promise<void> {
  try {
    const { result, transfer } = await perform(request);
    post({ type: "done", id: request.id, result }, transfer);
  } catch (error) {
    post({ type: "failed", id: request.id, ...failureOf(error) });
  }
}

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
  return answer(core.session, core.own, request.name, request.args);
}

function failureOf(error: unknown): Failure {
  if (error instanceof WebAssembly.RuntimeError) {
    const message = `The reconstruction core stopped (${error.message}).`;
    return { message, kind: "crash", orientationCheck: null };
  }
  if (error instanceof Error) {
    const { agreement: orientationCheck = null } = error as Error & { agreement?: AgreementReport };
    return {
      message: error.message,
      kind: error.name === "InputError" ? "input" : "internal",
      orientationCheck,
    };
  }
  return { message: String(error), kind: "internal", orientationCheck: null };
}

function post(reply: Reply, transfer: Transferable[] = []): void {
  self.postMessage(reply, transfer);
}

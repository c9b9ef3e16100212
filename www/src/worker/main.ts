/** The worker: one wasm instance with one Session. Requests are answered one after the other. */
/// <reference lib="webworker" />
import init, { Session } from "../pkg/ridgeline.js";
import type { WorkerCalls } from "../shared/calls";
import type { Reply, Request } from "../shared/messages";
import { type Answer, answer, type CoreSession, workerCalls } from "./calls";
import { failureOf } from "./failures";

declare const self: DedicatedWorkerGlobalScope;

let core: { session: CoreSession; own: WorkerCalls } | undefined;
let queue: Promise<void> = Promise.resolve();

self.onmessage = (event: MessageEvent<Request>) => {
  queue = queue.then(() => reply(event.data));
};

/** What the core wrote to the console last: a panic's message, of which the trap behind it says nothing. */
let lastWords: string | null = null;
const write = console.error.bind(console);
console.error = (...words: unknown[]) => {
  lastWords = String(words[0]);
  write(...words);
};

async function reply(request: Request): Promise<void> {
  lastWords = null;
  try {
    const { result, transfer } = await perform(request);
    post({ type: "done", id: request.id, result }, transfer);
  } catch (error) {
    post({ type: "failed", id: request.id, ...failureOf(error, lastWords) });
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

function post(reply: Reply, transfer: Transferable[] = []): void {
  self.postMessage(reply, transfer);
}

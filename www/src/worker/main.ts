/** The worker: one wasm instance with one Session. Requests are answered one after the other. */
/// <reference lib="webworker" />
import init, { Session } from "../pkg/ridgeline.js";
import type { Failure, Reply, Request } from "../shared/messages";
import type { OrientationCheckReport, Params } from "../shared/results";
import { type Answer, type Core, type CoreSession, dispatch } from "./dispatch";

declare const self: DedicatedWorkerGlobalScope;

let core: Core | undefined;
let queue: Promise<void> = Promise.resolve();

self.onmessage = (event: MessageEvent<Request>) => {
  queue = queue.then(() => answer(event.data));
};

async function answer(request: Request): Promise<void> {
  try {
    const { result, transfer } = await perform(request);
    post({ type: "done", id: request.id, result }, transfer);
  } catch (error) {
    post({ type: "failed", id: request.id, ...failureOf(error) });
  }
}

async function perform(request: Request): Promise<Answer> {
  if (request.type === "open") {
    await init({ module_or_path: request.args.wasmUrl });
    core = {
      session: new Session() as unknown as CoreSession,
      stages: Session.stages() as string[],
      defaults: Session.defaultParams() as Params,
    };
    return { result: { stages: core.stages, defaults: core.defaults }, transfer: [] };
  }
  if (core === undefined) {
    throw new Error("The reconstruction core is not ready. Reload the page.");
  }
  return dispatch(core, request, (stage, fraction) => post({ type: "progress", stage, fraction }));
}

function failureOf(error: unknown): Failure {
  if (error instanceof WebAssembly.RuntimeError) {
    const message = `The reconstruction core stopped (${error.message}).`;
    return { message, kind: "crash", orientationCheck: null };
  }
  if (error instanceof Error) {
    const { doctor: orientationCheck = null } = error as Error & { doctor?: OrientationCheckReport };
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

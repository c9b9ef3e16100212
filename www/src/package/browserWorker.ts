/** The worker that `createWorker` starts in a browser. */
import init, { Session } from "../pkg/ridgeline.js";
import type { Reply, Request } from "./client.js";
import { answer } from "./serve.js";

/** The worker's own scope, of which the page's types know nothing. */
interface Scope {
  onmessage: ((event: MessageEvent<Request>) => Promise<void>) | null;
  postMessage(reply: Reply): void;
}
const scope = self as unknown as Scope;

const wasm = new URL("../pkg/ridgeline_bg.wasm", import.meta.url);
const core = init({ module_or_path: wasm }).then(() => new Session());

scope.onmessage = async (event) => {
  answer(await core, event.data, (reply) => scope.postMessage(reply));
};

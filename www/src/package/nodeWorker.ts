/** The worker thread that `createWorker` starts in Node. */
import { readFileSync } from "node:fs";
import { parentPort } from "node:worker_threads";
import { initSync, Session } from "../pkg/ridgeline.js";
import type { Reply, Request } from "./client.js";
import { answer } from "./serve.js";

initSync({ module: readFileSync(new URL("../pkg/ridgeline_bg.wasm", import.meta.url)) });
const session = new Session();

parentPort?.on("message", (request: Request) => {
  answer(session, request, (reply: Reply) => parentPort?.postMessage(reply));
});

/** A worker of the orientation: one instance of the core's second module. Requests are answered one after the other. */
/// <reference lib="webworker" />
import init, { Orienter } from "../pkg-orient/orientation.js";
import type { OrientCalls, OrientedBlock, OrientReply, OrientRequest } from "../shared/orientation";
import { type Answer, answer, throttled, transferOf } from "./answering";
import { readBlob } from "./projectFiles";
import { serve } from "./serve";

declare const self: DedicatedWorkerGlobalScope;

let orienter: Orienter | undefined;
const reached = throttled((fraction) => post({ type: "progress", fraction }));
serve<OrientRequest>(perform, post);

async function perform(request: OrientRequest): Promise<Answer> {
  if (request.type === "open") {
    await init({ module_or_path: request.wasmUrl });
    orienter = new Orienter(request.options);
    return { result: undefined, transfer: [] };
  }
  if (orienter === undefined) {
    throw new Error("The core is not ready. Reload the page.");
  }
  return answer(callsOf(orienter), orienter, request);
}

type Own = Pick<
  OrientCalls,
  "readFile" | "readControl" | "measureLength" | "runShard" | "connect" | "orient" | "block"
>;

function callsOf(core: Orienter): Own {
  return {
    readFile: async (path, blob) => core.readPhoto(path, new Uint8Array(await readBlob(path, blob))),
    readControl: async (path, blob) => core.setControl(path, new Uint8Array(await readBlob(path, blob))),
    runShard: (map, index, of) => core.runShard(map, index, of, reached),
    measureLength: ([first, second]) => {
      const marks = [...first, ...second];
      const pixels = new Float64Array(marks.flatMap(({ x, y }) => [x, y]));
      const files = marks.map(({ file }) => file);
      return core.measureLength(files, pixels, first.length);
    },
    connect: () => core.connect(reached),
    orient: () =>
      core.orient(reached, (views, points, colours) => {
        const block = { views, points, colours };
        post({ type: "block", block }, transferOf(block));
      }),
    block: () => ({
      views: core.views(),
      points: core.points() as OrientedBlock["points"],
      colours: core.colours() as OrientedBlock["colours"],
    }),
  };
}

function post(message: OrientReply, transfer: Transferable[] = []): void {
  self.postMessage(message, transfer);
}

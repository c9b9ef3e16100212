/**
 * A worker around the fake core, in virtual time: each call takes its while, and what the real core would not forgive is
 * written down. For tests of what happens when actions overlap.
 */
import type { CallName } from "../../src/shared/calls";
import type { Reply, Request } from "../../src/shared/messages";
import { answer } from "../../src/worker/answering";
import { workerCalls } from "../../src/worker/calls";
import { failureOf } from "../../src/worker/failures";
import { Session } from "./ridgeline";

/** How long a call takes, milliseconds of virtual time; the others take one. */
export const TAKES: Partial<Record<CallName | "open", number>> = {
  open: 10,
  setFiles: 10,
  inspect: 5,
  load: 20,
  runStage: 30,
  adjustOnce: 30,
  runShard: 10,
  firstLook: 50,
  runTile: 60,
  exportProject: 20,
};

/** One at a time, in all workers. */
const RUNNING: readonly string[] = ["runStage", "adjustOnce", "runTile"];

/** What the real core would have answered with a crash or mixed results. */
export const violations: string[] = [];

/** How often stages ran, in all workers. */
export const ran: string[] = [];

/** Calls that fail once with what is thrown here, by name. */
export const failing = new Map<string, () => never>();

/** In how many rounds of the adjustment views will move. */
export const moving = { rounds: 0 };

let stagesAtWork = 0;

/** As strict as the real session about the order of calls. */
class StrictSession extends Session {
  #isLoaded = false;
  #shards: number[] = [];

  override clearFiles(): void {
    super.clearFiles();
    this.#isLoaded = false;
  }

  override load() {
    this.#isLoaded = false;
    this.#shards = [];
    const loaded = super.load();
    this.#isLoaded = true;
    return loaded;
  }

  override planTiles(): void {
    this.#isLoaded = false;
    super.planTiles();
  }

  override takeView(): void {
    this.#isLoaded = true;
  }

  override setParams(): void {
    this.#shards = [];
  }

  override runStage(stage: string, onProgress: (fraction: number) => void) {
    this.#demandScene();
    ran.push(stage);
    onProgress(1);
    return { stage, counts: { [stage]: 7 }, warnings: [] };
  }

  override adjustOnce(onProgress: (fraction: number) => void) {
    const summary = super.adjustOnce(onProgress);
    moving.rounds -= 1;
    return moving.rounds < 0 ? summary : null;
  }

  override runShard(
    stage: string,
    map: string,
    index: number,
    of: number,
    onProgress: (fraction: number) => void,
  ): Uint8Array<ArrayBuffer> {
    this.#demandScene();
    this.#shards = [];
    return super.runShard(stage, map, index, of, onProgress);
  }

  override mergeShards(_map?: string, shards: Uint8Array[] = []): void {
    for (const [index = 0, of = 0] of shards) {
      if (index !== this.#shards.length || index >= of) {
        violations.push(`shard ${index} of ${of} after ${this.#shards.length} others`);
      }
      this.#shards.push(index);
    }
  }

  #demandScene(): void {
    if (!this.#isLoaded) {
      throw Object.assign(new Error("no scene is loaded; add files and load them first"), {
        name: "InputError",
      });
    }
  }
}

export class FakeWorker {
  onmessage: (event: { data: Reply }) => void = () => {};
  onerror: (event: unknown) => void = () => {};
  #session = new StrictSession();
  #queue: Promise<void> = Promise.resolve();
  #isEnded = false;
  #stages = 0;

  postMessage(request: Request): void {
    const name = request.type === "open" ? "open" : request.name;
    if (RUNNING.includes(name)) {
      this.#stages += 1;
      stagesAtWork += 1;
      if (stagesAtWork > 1) {
        violations.push(`${stagesAtWork} stages at a time`);
      }
    }
    this.#queue = this.#queue.then(() => this.#answer(request, name));
  }

  terminate(): void {
    this.#isEnded = true;
    stagesAtWork -= this.#stages;
    this.#stages = 0;
  }

  async #answer(request: Request, name: CallName | "open"): Promise<void> {
    await new Promise((resolve) => setTimeout(resolve, TAKES[name] ?? 1));
    if (this.#isEnded) {
      return;
    }
    const reply = await this.#replyTo(request);
    if (this.#isEnded) {
      return;
    }
    if (RUNNING.includes(name)) {
      this.#stages -= 1;
      stagesAtWork -= 1;
    }
    this.onmessage({ data: reply });
  }

  async #replyTo(request: Request): Promise<Reply> {
    const { id } = request;
    if (request.type === "open") {
      return { type: "done", id, result: undefined };
    }
    try {
      const fail = failing.get(request.name);
      failing.delete(request.name);
      fail?.();
      const own = {
        ...workerCalls(this.#session, Session.defaultParams, () => {}),
        image: async () => ({ width: 4, height: 4, close: () => {} }) as ImageBitmap,
      };
      const { result } = await answer(own, this.#session, request);
      return { type: "done", id, result };
    } catch (error) {
      return { type: "failed", id, ...failureOf(error, null) };
    }
  }
}

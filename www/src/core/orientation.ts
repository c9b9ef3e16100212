/**
 * Photographs alone into their orientation: workers with the core's second module, which is fetched with the first of
 * them. Photographs are dealt to the workers one at a time, so that each holds the pixels of one only; the maps over pairs
 * are done in shards; the first worker registers the block.
 */
import orientUrl from "../pkg-orient/orientation_bg.wasm?url";
import type { Bytes, InputFile } from "../shared/calls";
import type { Outcome } from "../shared/messages";
import type {
  OrientationReport,
  OrientCallName,
  OrientCalls,
  OrientedBlock,
  OrientOptions,
  OrientReply,
  OrientRequest,
  PairSummary,
  PhotoFeatures,
} from "../shared/orientation";
import { EngineError, WorkerEnd } from "./engine";

type Args<K extends OrientCallName> = Parameters<OrientCalls[K]>;
type Result<K extends OrientCallName> = Awaited<ReturnType<OrientCalls[K]>>;

/** What is told while it goes on. */
export interface OrientEvents {
  onPhoto(found: PhotoFeatures, done: number): void;
  /** Pairs are sought: fraction of that. */
  onPairing(fraction: number): void;
  /** @param matches of the first of them: x, y in both photographs */
  onPairs(pairs: readonly PairSummary[], matches: Float32Array): void;
  /** The block is registered: fraction of that. */
  onRegistering(fraction: number): void;
  onBlock(block: OrientedBlock): void;
}

/** A worker's other end: calls as promises. */
class OrientWorker {
  onProgress: (fraction: number) => void = () => undefined;
  onBlock: (block: OrientedBlock) => void = () => undefined;
  readonly #end = new WorkerEnd<OrientRequest, Exclude<OrientReply, Outcome>>(
    new Worker(new URL("../worker/orientation.ts", import.meta.url), { type: "module" }),
    (told) => (told.type === "progress" ? this.onProgress(told.fraction) : this.onBlock(told.block)),
    () => undefined,
  );

  open(options: OrientOptions): Promise<void> {
    const wasmUrl = new URL(orientUrl, document.baseURI).href;
    return this.#end.ask({ type: "open", wasmUrl, options });
  }

  call<K extends OrientCallName>(name: K, ...args: Args<K>): Promise<Result<K>> {
    return this.#end.ask({ type: "call", name, args });
  }

  close(): void {
    this.#end.end(new EngineError("Cancelled.", "cancelled"));
  }
}

/** An orientation that is computed, and the worker that answers questions about it until it is closed. */
export class OrientationRun {
  #workers: OrientWorker[] = [];
  #isClosed = false;

  /**
   * Orients photographs with so many workers.
   * @param lists of ground control points, which give the frame, and of the photographs' own places
   */
  async orient(
    photographs: readonly InputFile[],
    lists: readonly InputFile[],
    workers: number,
    options: OrientOptions,
    events: OrientEvents,
  ): Promise<OrientationReport> {
    this.#workers = Array.from({ length: Math.min(workers, photographs.length) }, () => new OrientWorker());
    await Promise.all(this.#workers.map((worker) => worker.open(options)));
    // First of all: a list that cannot be read is known before anything is computed.
    for (const { path, blob } of lists) {
      await this.#first().call("readControl", path, blob);
    }
    await this.#read(photographs, events);
    await this.#pair(events);
    const first = this.#first();
    first.onProgress = events.onPairing;
    const pairs = await first.call("connect");
    events.onPairs(pairs, await first.call("pairMatches", 0));
    // The others are of no more use, and hold memory.
    this.#endOthers();
    first.onProgress = (fraction) =>
      events.onRegistering((fraction - REGISTERED_FROM) / (1 - REGISTERED_FROM));
    first.onBlock = events.onBlock;
    return first.call("orient");
  }

  /** Asks about what was found. */
  ask<K extends OrientCallName>(name: K, ...args: Args<K>): Promise<Result<K>> {
    return this.#first().call(name, ...args);
  }

  /** Ends all workers at once; open calls fail as cancelled. */
  close(): void {
    this.#isClosed = true;
    for (const worker of this.#workers.splice(0)) {
      worker.close();
    }
  }

  #first(): OrientWorker {
    const [first] = this.#workers;
    if (first === undefined || this.#isClosed) {
      throw new EngineError("Cancelled.", "cancelled");
    }
    return first;
  }

  /** Each worker takes the next photograph when it has read one; all are given what was read. */
  async #read(photographs: readonly InputFile[], events: OrientEvents): Promise<void> {
    const waiting = [...photographs];
    let done = 0;
    const readNext = async (worker: OrientWorker): Promise<void> => {
      for (let file = waiting.shift(); file !== undefined; file = waiting.shift()) {
        const read = await worker.call("readFile", file.path, file.blob);
        const [found] = await Promise.all(this.#workers.map((one) => one.call("takePhoto", read)));
        done += 1;
        if (found !== undefined) {
          events.onPhoto(found, done);
        }
      }
    };
    await Promise.all(this.#workers.map(readNext));
  }

  /** The maps over pairs, a shard a worker. */
  async #pair(events: OrientEvents): Promise<void> {
    const of = this.#workers.length;
    const maps = of > 1 ? await this.#first().call("shardMaps") : [];
    for (const [step, map] of maps.entries()) {
      const reached = this.#workers.map(() => 0);
      this.#workers.forEach((worker, index) => {
        worker.onProgress = (fraction) => {
          reached[index] = (fraction - PAIRED_FROM) / (REGISTERED_FROM - PAIRED_FROM);
          events.onPairing(Math.min(...reached));
        };
      });
      const shards: Bytes[] = await Promise.all(
        this.#workers.map((worker, index) => worker.call("runShard", map, index, of)),
      );
      // After the last map only the first one goes on.
      const merging = step + 1 < maps.length ? this.#workers : [this.#first()];
      await Promise.all(merging.map((worker) => worker.call("mergeShards", map, shards)));
    }
  }

  #endOthers(): void {
    for (const worker of this.#workers.splice(1)) {
      worker.close();
    }
  }
}

/** Fractions of the whole work at which pairs are begun, and the block. */
const PAIRED_FROM = 0.4;
const REGISTERED_FROM = 0.7;

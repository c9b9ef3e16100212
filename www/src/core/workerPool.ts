/**
 * The worker pool: besides the engine's own worker, others that each have a wasm instance and a
 * copy of the views. Every worker computes its shard of a stage's maps, and the engine then runs
 * the stage with the merged shards. The core sees to it that these are the bytes that one worker
 * would find. Without others, or where one fails, the engine runs by itself.
 */
import type { Bytes } from "../shared/calls";
import type { ParamTree } from "../shared/paramTree";
import type { Facet } from "../shared/records";
import { Engine, EngineError } from "./engine";

/** A worker, and what it holds of the run. */
interface PooledWorker {
  worker: Engine;
  views: "none" | "grey" | "colour";
  /** For each stage, which of its results. */
  taken: Map<string, number>;
  /** Whether it takes a first look meanwhile, and no shards. */
  isLooking: boolean;
}

interface Wanted {
  stage: string;
  /** The stages before it, whose results its maps may need. */
  earlier: readonly string[];
  views: number;
  params: ParamTree;
  /** How many workers, with the engine. */
  workers: number;
}

export class WorkerPool {
  #pooled: PooledWorker[] = [];
  #fractions: number[] = [];
  /** How often each stage was run: what a worker holds of an earlier run is out of date. */
  readonly #runs = new Map<string, number>();
  readonly #engine: Engine;
  readonly #onProgress: (stage: string, fraction: number) => void;

  constructor(engine: Engine, onProgress: (stage: string, fraction: number) => void) {
    this.#engine = engine;
    this.#onProgress = onProgress;
  }

  /** Computes the maps of a stage in shards; why that failed and the engine is to run by itself, or null. */
  async runShards(wanted: Wanted): Promise<Error | null> {
    const maps = await this.#engine.call("shardMaps", wanted.stage);
    if (wanted.workers < 2 || maps.length === 0) {
      return null;
    }
    try {
      await this.#resize(wanted.workers - 1);
      const sharing = this.#pooled.filter(({ isLooking }) => !isLooking);
      if (sharing.length === 0) {
        return null;
      }
      await this.#giveViews(
        sharing,
        wanted.views,
        await this.#engine.call("shardsReadColours", wanted.stage),
      );
      await this.#giveResults(sharing, wanted);
      await this.#giveCameras(sharing);
      await this.#doMaps(sharing, wanted.stage, maps);
      return null;
    } catch (error) {
      const cancelled = error instanceof EngineError && error.kind === "cancelled";
      if (cancelled || !this.#engine.isOpen) {
        throw error;
      }
      this.close();
      return error instanceof Error ? error : new Error(String(error));
    }
  }

  /** Starts workers that will be of use, while the engine reads its files. */
  hire(workers: number): void {
    // Who has work for them hears why there are none.
    this.#resize(workers - 1).catch(() => undefined);
  }

  /**
   * The facets of a preliminary model: one of the workers looks at reduced views while the others begin with the whole ones,
   * and shares what remains. Null where it was ended before, or failed: nothing depends on it.
   */
  async firstLook(packed: Bytes, params: ParamTree, workers: number): Promise<Facet[] | null> {
    // Where the engine works alone, one is hired for this.
    const opened = this.#resize(Math.max(1, workers - 1));
    const [looking] = this.#pooled;
    if (looking === undefined) {
      return null;
    }
    // From now on: a stage that begins while the worker starts does not wait for it.
    looking.isLooking = true;
    try {
      await opened;
      await looking.worker.call("setParams", params);
      return await looking.worker.callMoving([packed.buffer], "firstLook", packed);
    } catch {
      return null;
    } finally {
      looking.isLooking = false;
      if (workers < 2 || !looking.worker.isOpen) {
        looking.worker.close();
        this.#pooled = this.#pooled.filter((one) => one !== looking);
      }
    }
  }

  /** The engine has run a stage (again). */
  hasRun(stage: string): void {
    this.#runs.set(stage, (this.#runs.get(stage) ?? 0) + 1);
  }

  /** The engine's part of the progress. */
  engineReached(stage: string, fraction: number): void {
    this.#reached(0, stage, fraction);
  }

  /** There will be another scene. */
  forgetViews(): void {
    for (const one of this.#pooled) {
      one.views = "none";
    }
  }

  /** Ends all workers but the engine's at once. */
  close(): void {
    for (const { worker } of this.#pooled) {
      worker.close();
    }
    this.#pooled = [];
    this.#fractions = [];
  }

  async #resize(count: number): Promise<void> {
    for (const { worker } of this.#pooled.splice(Math.max(0, count))) {
      worker.close();
    }
    const opening: Promise<unknown>[] = [];
    while (this.#pooled.length < count) {
      const index = this.#pooled.length + 1;
      const worker = new Engine((stage, fraction) => this.#reached(index, stage, fraction));
      this.#pooled.push({ worker, views: "none", taken: new Map(), isLooking: false });
      opening.push(worker.open());
    }
    try {
      await Promise.all(opening);
    } catch (error) {
      this.#pooled = this.#pooled.filter(({ worker }) => worker.isOpen);
      throw error;
    }
  }

  /** View by view, so that only one of them is on its way at a time. */
  async #giveViews(sharing: readonly PooledWorker[], count: number, withColours: boolean): Promise<void> {
    const wanted = withColours ? "colour" : "grey";
    const lacking = sharing.filter(({ views }) => views !== "colour" && views !== wanted);
    for (let view = 0; view < count && lacking.length > 0; view += 1) {
      const packed = await this.#engine.call("packView", view, withColours);
      await giveAll(workersOf(lacking), [packed], (worker, transfer) =>
        worker.callMoving(transfer, "takeView", view, count, packed),
      );
    }
    for (const one of lacking) {
      one.views = wanted;
      one.taken.clear();
    }
  }

  /** Parameters first: they drop the results that they change, which the engine then has run again. */
  async #giveResults(sharing: readonly PooledWorker[], { earlier, params }: Wanted): Promise<void> {
    await Promise.all(sharing.map(({ worker }) => worker.call("setParams", params)));
    for (const stage of earlier) {
      const run = this.#runs.get(stage) ?? 0;
      const lacking = sharing.filter(({ taken }) => taken.get(stage) !== run);
      const found = lacking.length > 0 ? await this.#engine.call("handOver", stage) : new Uint8Array();
      if (found.length > 0) {
        await giveAll(workersOf(lacking), [found], (worker, transfer) =>
          worker.callMoving(transfer, "takeOver", stage, found),
        );
      }
      for (const { taken } of lacking) {
        taken.set(stage, run);
      }
    }
  }

  /** After the parameters, which may move cameras as the adjustment does. */
  async #giveCameras(sharing: readonly PooledWorker[]): Promise<void> {
    const packed = await this.#engine.call("packCameras");
    await giveAll(workersOf(sharing), [packed], (worker, transfer) =>
      worker.callMoving(transfer, "takeCameras", packed),
    );
  }

  async #doMaps(sharing: readonly PooledWorker[], stage: string, maps: readonly string[]): Promise<void> {
    const workers = [this.#engine, ...workersOf(sharing)];
    this.#fractions = workers.map(() => 0);
    const of = workers.length;
    for (const [step, map] of maps.entries()) {
      const shards: Bytes[] = await Promise.all(
        workers.map((worker, index) => worker.call("runShard", stage, map, index, of)),
      );
      // After the last map only the engine goes on.
      const merging = step + 1 < maps.length ? workers : [this.#engine];
      await giveAll(merging, shards, (worker, transfer) =>
        worker.callMoving(transfer, "mergeShards", map, shards),
      );
    }
    this.#fractions = [];
  }

  /** Workers begin a stage anew for each of its maps: what counts is how far they came. */
  #reached(index: number, stage: string, fraction: number): void {
    if (this.#fractions.length === 0) {
      this.#onProgress(stage, fraction);
      return;
    }
    this.#fractions[index] = Math.max(this.#fractions[index] ?? 0, fraction);
    this.#onProgress(stage, this.#fractions.reduce((sum, one) => sum + one, 0) / this.#fractions.length);
  }
}

/** Gives all workers the same bytes: the last one gets them themselves, since copying tens of megabytes holds the page up. */
async function giveAll(
  workers: readonly Engine[],
  bytes: readonly Bytes[],
  give: (worker: Engine, transfer: readonly Transferable[]) => Promise<unknown>,
): Promise<void> {
  const buffers = bytes.map(({ buffer }) => buffer);
  await Promise.all(workers.map((worker, i) => give(worker, i + 1 < workers.length ? [] : buffers)));
}

function workersOf(pooled: readonly PooledWorker[]): Engine[] {
  return pooled.map(({ worker }) => worker);
}

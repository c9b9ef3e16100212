/**
 * The workers that help the engine with a stage: each has a wasm instance of its own and a copy of the views, does its
 * share of the stage's maps, and the engine then runs the stage with everybody's results. The core sees to it that
 * these are the bytes that the engine alone would find. Without helpers, or where one fails, it is alone.
 */
import type { Bytes } from "../shared/messages";
import type { Params } from "../shared/results";
import { Engine, EngineError } from "./engine";

/** A worker, and what it holds of the run. */
interface Helper {
  worker: Engine;
  views: "none" | "grey" | "colour";
  /** For each stage, which of its results. */
  taken: Map<string, number>;
}

interface Wanted {
  stage: string;
  /** The stages before it, whose results its maps may need. */
  earlier: readonly string[];
  views: number;
  params: Params;
  /** How many workers, with the engine. */
  workers: number;
}

export class Crew {
  #helpers: Helper[] = [];
  #heard: number[] = [];
  /** How often each stage was run: what a helper holds of an earlier run is out of date. */
  readonly #runs = new Map<string, number>();
  readonly #engine: Engine;
  readonly #onProgress: (stage: string, fraction: number) => void;

  constructor(engine: Engine, onProgress: (stage: string, fraction: number) => void) {
    this.#engine = engine;
    this.#onProgress = onProgress;
  }

  /** Does the shared maps of a stage; false where that failed and the engine is to run alone. */
  async share(wanted: Wanted): Promise<boolean> {
    const { maps, withColours } = await this.#engine.call("sharedMaps", { stage: wanted.stage });
    if (wanted.workers < 2 || maps.length === 0) {
      return true;
    }
    try {
      await this.#hire(wanted.workers - 1);
      await this.#giveViews(wanted.views, withColours);
      await this.#giveResults(wanted);
      await this.#doMaps(wanted.stage, maps);
      return true;
    } catch (error) {
      const cancelled = error instanceof EngineError && error.kind === "cancelled";
      if (cancelled || !this.#engine.isOpen) {
        throw error;
      }
      this.close();
      return false;
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
    for (const helper of this.#helpers) {
      helper.views = "none";
    }
  }

  /** Ends all helpers at once. */
  close(): void {
    for (const { worker } of this.#helpers) {
      worker.close();
    }
    this.#helpers = [];
    this.#heard = [];
  }

  async #hire(count: number): Promise<void> {
    for (const { worker } of this.#helpers.splice(count)) {
      worker.close();
    }
    const hired: Promise<unknown>[] = [];
    while (this.#helpers.length < count) {
      const index = this.#helpers.length + 1;
      const worker = new Engine((stage, fraction) => this.#reached(index, stage, fraction));
      this.#helpers.push({ worker, views: "none", taken: new Map() });
      hired.push(worker.open());
    }
    await Promise.all(hired);
  }

  /** View by view, so that only one of them is on its way at a time. */
  async #giveViews(count: number, withColours: boolean): Promise<void> {
    const wanted = withColours ? "colour" : "grey";
    const lacking = this.#helpers.filter(({ views }) => views !== "colour" && views !== wanted);
    for (let view = 0; view < count && lacking.length > 0; view += 1) {
      const packed = await this.#engine.call("packView", { view, withColours });
      await giveAll(workersOf(lacking), [packed], (worker, transfer) =>
        worker.call("takeView", { view, of: count, packed }, transfer),
      );
    }
    for (const helper of lacking) {
      helper.views = wanted;
      helper.taken.clear();
    }
  }

  /** Parameters first: they drop the results that they change, which the engine then has run again. */
  async #giveResults({ earlier, params }: Wanted): Promise<void> {
    await Promise.all(this.#helpers.map(({ worker }) => worker.call("setParams", { params })));
    for (const stage of earlier) {
      const run = this.#runs.get(stage) ?? 0;
      const lacking = this.#helpers.filter(({ taken }) => taken.get(stage) !== run);
      const found = lacking.length > 0 ? await this.#engine.call("handOver", { stage }) : new Uint8Array();
      if (found.length > 0) {
        await giveAll(workersOf(lacking), [found], (worker, transfer) =>
          worker.call("takeOver", { stage, found }, transfer),
        );
      }
      for (const { taken } of lacking) {
        taken.set(stage, run);
      }
    }
  }

  async #doMaps(stage: string, maps: readonly string[]): Promise<void> {
    const workers = [this.#engine, ...workersOf(this.#helpers)];
    this.#heard = workers.map(() => 0);
    const of = workers.length;
    for (const [step, map] of maps.entries()) {
      const shares: Bytes[] = await Promise.all(
        workers.map((worker, index) => worker.call("share", { stage, map, index, of })),
      );
      // After the last map only the engine goes on.
      const learners = step + 1 < maps.length ? workers : [this.#engine];
      await giveAll(learners, shares, (worker, transfer) => worker.call("learn", { map, shares }, transfer));
    }
    this.#heard = [];
  }

  /** Workers begin a stage anew for each of its maps: what counts is how far they came. */
  #reached(index: number, stage: string, fraction: number): void {
    if (this.#heard.length === 0) {
      this.#onProgress(stage, fraction);
      return;
    }
    this.#heard[index] = Math.max(this.#heard[index] ?? 0, fraction);
    this.#onProgress(stage, this.#heard.reduce((sum, heard) => sum + heard, 0) / this.#heard.length);
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

function workersOf(helpers: readonly Helper[]): Engine[] {
  return helpers.map(({ worker }) => worker);
}

import { beforeEach, describe, expect, it, vi } from "vitest";
import type { Engine } from "../../../src/core/engine";
import type { WorkerPool } from "../../../src/core/workerPool";

/** Every call of every worker, in their order: worker, call, arguments, what moves along. */
let calls: [number, string, readonly unknown[], readonly Transferable[]][] = [];
/** The worker whose shards fail. */
let broken = -1;
let why = "crash";
/** The worker that cannot be started. */
let unopened = -1;
let made = 0;
/** When first looks end. */
let looked: Promise<void> = Promise.resolve();

class FakeEngine {
  readonly number = made++;
  isOpen = true;
  readonly onProgress: (stage: string, fraction: number) => void;

  constructor(onProgress: (stage: string, fraction: number) => void) {
    this.onProgress = onProgress;
  }

  async open(): Promise<void> {
    if (this.number === unopened) {
      this.isOpen = false;
      throw new EngineError("cannot be started", "crash");
    }
  }

  close(): void {
    this.isOpen = false;
  }

  call(name: string, ...args: readonly unknown[]): Promise<unknown> {
    return this.callMoving([], name, ...args);
  }

  async callMoving(
    transfer: readonly Transferable[],
    name: string,
    ...args: readonly unknown[]
  ): Promise<unknown> {
    calls.push([this.number, name, args, transfer]);
    if (name === "shardMaps") {
      return ["heights", "pairs"];
    }
    if (name === "shardsReadColours") {
      return false;
    }
    if (name === "firstLook") {
      await looked;
      return [{ facet: this.number }];
    }
    if (name === "runShard") {
      if (this.number === broken) {
        throw new EngineError("stopped", why);
      }
      this.onProgress("matches", 0.5);
    }
    return new Uint8Array([this.number + 1]);
  }
}

class EngineError extends Error {
  readonly kind: string;

  constructor(message: string, kind: string) {
    super(message);
    this.kind = kind;
  }
}

vi.mock("../../../src/core/engine", () => ({ Engine: FakeEngine, EngineError }));

const fractions: number[] = [];
const wanted = { stage: "matches", earlier: ["segments"], views: 2, params: {}, workers: 3 };

async function poolOf(): Promise<WorkerPool> {
  const { WorkerPool: Pool } = await import("../../../src/core/workerPool");
  const engine = new FakeEngine((stage, fraction) => pool.engineReached(stage, fraction));
  const pool = new Pool(engine as unknown as Engine, (_, fraction) => fractions.push(fraction));
  return pool;
}

const of = (type: string) => calls.filter(([, name]) => name === type);

describe("worker pool", () => {
  beforeEach(() => {
    calls = [];
    fractions.length = 0;
    broken = -1;
    unopened = -1;
    looked = Promise.resolve();
    why = "crash";
    made = 0;
  });

  it("gives a shard of every map to all workers and merges the shards by their index", async () => {
    const pool = await poolOf();
    expect(await pool.runShards(wanted)).toBeNull();
    expect(of("runShard").map(([worker, , [, map, index, all]]) => [worker, map, index, all])).toEqual([
      [0, "heights", 0, 3],
      [1, "heights", 1, 3],
      [2, "heights", 2, 3],
      [0, "pairs", 0, 3],
      [1, "pairs", 1, 3],
      [2, "pairs", 2, 3],
    ]);
    const merged = of("mergeShards");
    expect(merged.map(([worker, , [map]]) => [worker, map])).toEqual([
      [0, "heights"],
      [1, "heights"],
      [2, "heights"],
      [0, "pairs"],
    ]);
    expect(merged[0]?.[2][1]).toEqual([1, 2, 3].map((n) => new Uint8Array([n])));
    expect(fractions.at(2)).toBeCloseTo(0.5);
  });

  it("gives views once, and results only when they are new", async () => {
    const pool = await poolOf();
    pool.hasRun("segments");
    await pool.runShards(wanted);
    expect(of("takeView").length).toBe(4);
    expect(of("takeOver").length).toBe(2);
    await pool.runShards(wanted);
    expect(of("takeView").length).toBe(4);
    expect(of("takeOver").length).toBe(2);
    pool.hasRun("segments");
    await pool.runShards(wanted);
    expect(of("takeOver").length).toBe(4);
    pool.forgetViews();
    await pool.runShards(wanted);
    expect(of("takeView").length).toBe(8);
    expect(of("takeOver").length).toBe(6);
  });

  it("gives the cameras before every stage, after the parameters", async () => {
    const pool = await poolOf();
    await pool.runShards(wanted);
    await pool.runShards(wanted);
    expect(of("takeCameras").length).toBe(4);
    const ofOne = calls.filter(([worker]) => worker === 1).map(([, name]) => name);
    expect(ofOne.indexOf("setParams")).toBeLessThan(ofOne.indexOf("takeCameras"));
    expect(ofOne.indexOf("takeCameras")).toBeLessThan(ofOne.indexOf("runShard"));
  });

  it("copies for all workers but the last, which gets the bytes themselves", async () => {
    const pool = await poolOf();
    pool.hasRun("segments");
    await pool.runShards(wanted);
    const moved = (type: string) => of(type).map(([worker, , , transfer]) => [worker, transfer.length]);
    const eachView = [
      [1, 0],
      [2, 1],
    ];
    expect(moved("takeView")).toEqual([...eachView, ...eachView]);
    expect(moved("takeOver")).toEqual(eachView);
    expect(moved("mergeShards")).toEqual([
      [0, 0],
      [1, 0],
      [2, 3],
      [0, 3],
    ]);
  });

  it("ends with the run that is cancelled", async () => {
    broken = 1;
    why = "cancelled";
    const pool = await poolOf();
    await expect(pool.runShards(wanted)).rejects.toMatchObject({ kind: "cancelled" });
  });

  it("leaves the engine by itself where a worker fails, or none is wanted", async () => {
    broken = 2;
    const pool = await poolOf();
    expect(await pool.runShards(wanted)).toMatchObject({ message: "stopped" });
    calls = [];
    expect(await pool.runShards({ ...wanted, workers: 1 })).toBeNull();
    expect(of("runShard")).toEqual([]);
  });

  it("has one worker look first while the others share stages, and then share them too", async () => {
    let end = () => {};
    looked = new Promise((resolve) => {
      end = resolve;
    });
    const pool = await poolOf();
    const views = new Uint8Array(1);
    const found = pool.firstLook(views, {}, wanted.workers);
    await pool.runShards(wanted);
    expect(new Set(of("runShard").map(([worker]) => worker))).toEqual(new Set([0, 2]));
    expect(of("runShard")[0]?.[2].at(-1)).toBe(2);
    end();
    expect(await found).toEqual([{ facet: 1 }]);
    expect(of("firstLook")[0]?.[3]).toEqual([views.buffer]);
    await pool.runShards(wanted);
    expect(
      new Set(
        of("runShard")
          .slice(-6)
          .map(([worker]) => worker),
      ),
    ).toEqual(new Set([0, 1, 2]));
  });

  it("hires a worker for a first look where the engine works alone, and ends it", async () => {
    looked = Promise.resolve();
    const pool = await poolOf();
    expect(await pool.firstLook(new Uint8Array(1), {}, 1)).toEqual([{ facet: 1 }]);
    await pool.runShards({ ...wanted, workers: 2 });
    expect(of("runShard").map(([worker]) => worker)).toContain(2);
    expect(of("runShard").map(([worker]) => worker)).not.toContain(1);
  });

  it("has no first look of a worker that is ended", async () => {
    looked = new Promise(() => {});
    const pool = await poolOf();
    const failing = pool.firstLook(new Uint8Array(1), {}, 2);
    looked = Promise.reject(new EngineError("ended", "cancelled"));
    await expect(failing).resolves.toBeNull();
  });

  it("has workers started before there is work, and goes on without one that does not start", async () => {
    const pool = await poolOf();
    pool.hire(3);
    await pool.runShards(wanted);
    expect(made).toBe(3);
    pool.close();
    unopened = 3;
    pool.hire(2);
    await new Promise((resolve) => setTimeout(resolve));
    expect(await pool.firstLook(new Uint8Array(1), {}, 2)).toEqual([{ facet: 4 }]);
    unopened = 5;
    pool.close();
    expect(await pool.firstLook(new Uint8Array(1), {}, 2)).toBeNull();
    unopened = 6;
    expect(await pool.runShards({ ...wanted, workers: 2 })).toMatchObject({ message: "cannot be started" });
  });
});

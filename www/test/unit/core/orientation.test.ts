/** Photographs and pairs are dealt to workers, and what one has read is given to all. */
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { nearestMatch } from "../../../src/app/project/orienting/pairGeometry";
import { drawnPlan, exaggeration } from "../../../src/app/project/orienting/plans/overlapGeometry";
import { planResiduals, rms, roleText } from "../../../src/app/project/orienting/plans/residuals";
import { OrientationRun, type OrientEvents } from "../../../src/core/orientation";
import type { OrientReply, OrientRequest } from "../../../src/shared/orientation";

vi.mock("../../../src/pkg/ridgeline_bg.wasm?url", () => ({ default: "none" }));
vi.mock("../../../src/pkg-orient/orientation_bg.wasm?url", () => ({ default: "orientation" }));

/** A worker that answers at once and keeps what it was asked. */
class FakeWorker {
  static made: FakeWorker[] = [];
  onmessage: (event: { data: OrientReply }) => void = () => undefined;
  asked: string[] = [];
  isEnded = false;

  constructor() {
    FakeWorker.made.push(this);
  }

  postMessage(request: OrientRequest): void {
    const words = request.type === "open" ? "open" : `${request.name} ${request.args.join(" ")}`;
    this.asked.push(words.trim());
    const result =
      request.type === "open" ? undefined : ANSWERS[request.name]?.(...(request.args as string[]));
    queueMicrotask(() => {
      if (!this.isEnded && result !== "never") {
        this.onmessage({ data: { type: "done", id: request.id, result } });
      }
    });
  }

  terminate(): void {
    this.isEnded = true;
  }
}

const ANSWERS: Record<string, (...args: string[]) => unknown> = {
  readFile: (path) => `read ${path}`,
  takePhoto: (read) => ({ file: read, size: [4, 3], keypoints: 9, problem: null }),
  shardMaps: () => ["matches", "pairs"],
  runShard: (map, index) => `${map}${index}`,
  connect: () => [{ first: "a", second: "b", kind: "general", matches: 1, angle_deg: 5 }],
  pairMatches: () => new Float32Array([1, 2, 3, 4]),
  orient: () => ({ photos: [] }),
};

const silent: OrientEvents = {
  onPhoto: () => undefined,
  onPairing: () => undefined,
  onPairs: () => undefined,
  onRegistering: () => undefined,
  onBlock: () => undefined,
};

const photographs = ["a.jpg", "b.jpg", "c.jpg", "d.jpg"].map((path) => ({ path, blob: new Blob() }));

describe("an orientation by several workers", () => {
  beforeEach(() => {
    FakeWorker.made = [];
    vi.stubGlobal("Worker", FakeWorker);
    vi.stubGlobal("document", { baseURI: "http://localhost/" });
  });
  afterEach(() => vi.unstubAllGlobals());

  it("gives the first a list of ground control points before anything else", async () => {
    const list = { path: "gcp_list.txt", blob: new Blob() };
    await new OrientationRun().orient(photographs, [list], 2, {}, silent);
    const [first, second] = FakeWorker.made as [FakeWorker, FakeWorker];
    expect(first.asked[1]).toMatch(/^readControl gcp_list.txt/);
    expect(second.asked.filter((words) => words.startsWith("readControl"))).toEqual([]);
  });

  it("deals photographs and pairs, and goes on with one", async () => {
    const run = new OrientationRun();
    const done: number[] = [];
    await run.orient(photographs, [], 2, {}, { ...silent, onPhoto: (_, count) => done.push(count) });
    const [first, second] = FakeWorker.made as [FakeWorker, FakeWorker];
    expect(FakeWorker.made.length).toBe(2);
    expect(done).toEqual([1, 2, 3, 4]);
    const of = (worker: FakeWorker, name: string) => worker.asked.filter((words) => words.startsWith(name));
    const read = [...of(first, "readFile"), ...of(second, "readFile")];
    expect(read.map((words) => words.split(" ")[1]).sort()).toEqual(photographs.map(({ path }) => path));
    for (const worker of [first, second]) {
      expect(of(worker, "takePhoto").sort()).toEqual(photographs.map(({ path }) => `takePhoto read ${path}`));
    }
    expect(of(first, "runShard")).toEqual(["runShard matches 0 2", "runShard pairs 0 2"]);
    expect(of(second, "runShard")).toEqual(["runShard matches 1 2", "runShard pairs 1 2"]);
    expect(of(first, "mergeShards")).toEqual([
      "mergeShards matches matches0,matches1",
      "mergeShards pairs pairs0,pairs1",
    ]);
    // After the last map the second one is of no more use.
    expect(of(second, "mergeShards")).toEqual(["mergeShards matches matches0,matches1"]);
    expect([first.isEnded, second.isEnded]).toEqual([false, true]);
    expect(first.asked.slice(-3)).toEqual(["connect", "pairMatches 0", "orient"]);
  });

  it("needs no shards with one worker", async () => {
    await new OrientationRun().orient(photographs, [], 1, {}, silent);
    expect(FakeWorker.made[0]?.asked.some((words) => words.startsWith("runShard"))).toBe(false);
  });

  it("ends as cancelled when it is closed, and answers nothing more", async () => {
    const run = new OrientationRun();
    const read = ANSWERS["readFile"];
    ANSWERS["readFile"] = () => "never";
    const ending = run.orient(photographs, [], 2, {}, silent).catch(({ kind }) => kind);
    await new Promise((resolve) => setTimeout(resolve, 5));
    run.close();
    ANSWERS["readFile"] = read as () => unknown;
    expect(await ending).toBe("cancelled");
    expect(FakeWorker.made.every(({ isEnded }) => isEnded)).toBe(true);
    expect(() => run.ask("block")).toThrow("Cancelled.");
  });
});

describe("the plan of the cameras", () => {
  it("fits its drawing, north up", () => {
    const places = drawnPlan(
      [
        [0, 0, 5],
        [40, 0, 5],
        [0, 20, 5],
      ],
      100,
      10,
    );
    expect(places).toEqual([
      [10, 70],
      [90, 70],
      [10, 30],
    ]);
    expect(drawnPlan([[3, 3, 3]], 100, 10)).toEqual([[50, 50]]);
  });
});

describe("residuals on the plan", () => {
  const point = (name: string, is_check: boolean, residual: [number, number, number | null] | null) => ({
    name,
    role: { is_check, known: residual?.[2] === null ? ("plan" as const) : ("all" as const) },
    stated: [0, 0, 0] as [number, number, number],
    marks: [2, 2] as [number, number],
    wrong_marks: [],
    place_m: residual === null ? null : ([10, 20, 30] as [number, number, number]),
    residual_m: residual,
    sigma_m: 0.02,
    agrees: true,
  });

  it("are drawn so long that the longest is seen, by a round factor", () => {
    const square = [
      [0, 0],
      [60, 30],
    ] as const;
    expect(exaggeration(square, [[0.3, 0.4]])).toBe(20);
    expect(exaggeration(square, [[0, 0.012]])).toBe(500);
    expect(exaggeration(square, [[0, 25]])).toBeCloseTo(0.2);
    expect(exaggeration(square, [[0, 0]])).toBe(1);
  });

  it("are those of points where there are any, else of stated positions", () => {
    const control = [
      point("a", false, [0.3, 0.4, null]),
      point("b", true, [3, 4, 2]),
      point("c", true, null),
    ];
    const shown = planResiduals({ control, photos: [] }, []);
    expect(shown.map(({ kind, offset }) => [kind, offset])).toEqual([
      ["used", [0.3, 0.4]],
      ["check", [3, 4]],
    ]);
    expect(control.map(({ role }) => roleText(role))).toEqual(["control, plan only", "check", "check"]);
    expect(rms(control.slice(0, 1))).toEqual([0.5, null]);
    expect(rms(control.slice(1))).toEqual([5, 2]);
    const photo = { file: "d.jpg", rays: 1, rms_px: 1, sigma_m: null, sigma_deg: null, partners: 1 };
    const stated = { ...photo, from_stated_m: null, residual_m: [1, 2, 3] as [number, number, number] };
    const of = planResiduals({ control: [], photos: [stated] }, [[5, 6, 7]]);
    expect(of).toEqual([{ name: "d.jpg", place: [5, 6, 7], offset: [1, 2], kind: "used" }]);
  });
});

describe("the nearest match", () => {
  it("is that of the side that was clicked", () => {
    const matches = new Float32Array([10, 10, 90, 90, 50, 50, 20, 20]);
    expect(nearestMatch(matches, 0, 12, 9)).toBe(0);
    expect(nearestMatch(matches, 1, 12, 9)).toBe(1);
    expect(nearestMatch(new Float32Array(), 0, 1, 1)).toBe(0);
  });
});

/**
 * The page's actions in any order: every ordered pair of them, the second at several moments of the first. The core is a
 * fake one in virtual time; queue, session and project are the page's own.
 */
import { afterAll, beforeAll, describe, expect, it, vi } from "vitest";
import type { InputFile } from "../../../src/shared/calls";
import { FakeWorker, failing, moving, ran, TAKES, violations } from "../../fake/worker";

vi.mock("../../../src/pkg/ridgeline_bg.wasm?url", () => ({ default: "none" }));
vi.mock("../../../src/app/parts/saveFile", () => ({ saveFile: () => {} }));
vi.mock("../../../src/app/project/storedProject", () => ({
  readStoredResults: async () => null,
  readStoredProject: async () => ({
    name: "Own files",
    isDemo: false,
    files: views("stored", 4),
    options: {},
    params: {},
  }),
}));

function views(folder: string, count: number): InputFile[] {
  return Array.from({ length: count }, (_, i) => ({ path: `${folder}/${i}.jpg`, blob: new Blob(["image"]) }));
}

const MANIFEST = JSON.stringify({ title: "Demo", files: ["a", "b", "c", "d"].map((name) => `${name}.jpg`) });

/** The demo scene comes after a while, unless it is no longer wanted. */
function fetchSlowly(url: URL, { signal }: { signal: AbortSignal }): Promise<Response> {
  return new Promise((resolve, reject) => {
    signal.addEventListener("abort", () => reject(signal.reason));
    setTimeout(() => resolve(new Response(url.pathname.endsWith(".json") ? MANIFEST : "image")), 10);
  });
}

async function pageModules() {
  const [
    session,
    runs,
    project,
    steps,
    opening,
    compared,
    kept,
    state,
    stages,
    notices,
    params,
    tour,
    activity,
    scene,
    results,
    dragged,
    list,
  ] = await Promise.all([
    import("../../../src/app/session/session"),
    import("../../../src/app/session/stageRuns"),
    import("../../../src/app/project/projectActions"),
    import("../../../src/app/tour/steps"),
    import("../../../src/app/shell/openingState"),
    import("../../../src/app/results/comparison/comparedResults"),
    import("../../../src/app/state/keptResult"),
    import("../../../src/app/state/project"),
    import("../../../src/app/state/stages"),
    import("../../../src/app/state/notices"),
    import("../../../src/app/state/parameters"),
    import("../../../src/app/state/tour"),
    import("../../../src/app/state/activity"),
    import("../../../src/app/state/scene"),
    import("../../../src/app/state/results"),
    import("../../../src/app/session/draggedParam"),
    import("../../../src/app/session/steps"),
  ]);
  const { RULES, SAME_AGAIN } = await import("../../../src/app/session/actionRules");
  return {
    ...session,
    ...runs,
    ...project,
    ...steps,
    ...opening,
    ...compared,
    ...kept,
    ...state,
    ...stages,
    ...notices,
    ...params,
    ...tour,
    ...activity,
    ...scene,
    ...results,
    ...dragged,
    ...list,
    RULES,
    SAME_AGAIN,
  };
}
type PageModules = Awaited<ReturnType<typeof pageModules>>;
type Kind = keyof PageModules["RULES"];

let page: PageModules;

/** What a person can do, with the kind that the rules have for it; null: done at once, no action. */
const ACTIONS: Readonly<Record<string, readonly [Kind | null, () => unknown]>> = {
  demo: ["open", () => page.openDemo()],
  "own files": ["open", () => page.openFiles(views("own", 5))],
  "new project": ["open", () => page.clearProject()],
  "last visit": ["restore", () => page.restoreOpeningState()],
  "more files": ["change", () => page.addFiles(views("more", 3))],
  "remove a file": ["change", () => page.removeFile(page.files.value[0]?.path ?? "")],
  "height of the ground": ["change", () => page.setRunOptions({ groundZ: 5 })],
  tiles: ["change", () => page.setRunOptions({ tileM: 50 })],
  "run a stage": ["run", () => page.runTo("matches")],
  "run all": ["run", () => page.runAll()],
  tour: ["tour", () => page.goTo(3)],
  method: ["method", () => page.setMethod("rectangles")],
  parameter: [null, () => page.setParam("sweep.min_similarity", 0.5)],
  compare: [null, () => page.keepResult(page.presentResult())],
  undo: ["open", () => page.notices.value.find(({ action }) => action !== undefined)?.action?.run()],
  "save project": ["save", () => page.saveProject()],
  "save a file": ["save", () => page.download("model.glb")],
  cancel: ["cancel", () => page.cancel()],
};
const NAMES = Object.keys(ACTIONS);

/** At once, while files are read, while the scene is loaded, in the middle of a run, milliseconds. */
const DELAYS = [0, 12, 32, 120];

function begin(name: string): void {
  void ACTIONS[name]?.[1]();
}

async function untilIdle(): Promise<void> {
  for (let i = 0; i < 400 && (i < 2 || !page.actions.isIdle); i += 1) {
    await vi.advanceTimersByTimeAsync(20);
  }
  expect(page.actions.isIdle).toBe(true);
  // Its run is over.
  expect(page.preliminaryFacets.value).toBeNull();
}

/** Own files are open and loaded, and nothing has run. */
async function beginAnew(): Promise<void> {
  void page.openFiles(views("base", 5));
  await untilIdle();
  page.endTour();
  await page.setMethod("lines");
  page.resetParams();
  page.dismissAbout("project");
  violations.length = 0;
  ran.length = 0;
}

/** What is left when all has come to rest. */
function outcome(): object {
  const { groundZ, tileM } = page.runOptions.value;
  return {
    files: page.files.value.map(({ path }) => path).sort(),
    isDemo: page.isDemo.value,
    groundZ,
    tileM,
    method: page.method.value,
    parameters: page.params.value,
    tourStep: page.tourStep.value,
    stages: page.stages.value.map(({ name, status }) => `${name} ${status}`),
  };
}

/** The outcome of actions one after the other, each after the last has come to rest. */
const inTurn = new Map<string, object>();
async function outcomeOf(names: readonly string[]): Promise<object> {
  const key = names.join(", ");
  const known = inTurn.get(key);
  if (known !== undefined) {
    return known;
  }
  await beginAnew();
  for (const name of names) {
    begin(name);
    await untilIdle();
  }
  inTurn.set(key, outcome());
  return outcome();
}

/** The outcomes that the rules allow for a second action in this phase of the first. */
async function allowed(
  first: string,
  second: string,
  phase: PageModules["phase"]["value"],
): Promise<object[]> {
  const kind = ACTIONS[second]?.[0] ?? null;
  const one = () => outcomeOf([first]);
  const other = () => outcomeOf([second]);
  const both = () => outcomeOf([first, second]);
  if (phase === null) {
    return [await both()];
  }
  const rule = kind === null ? "beside" : page.RULES[kind][phase];
  switch (first === second && kind !== null ? page.SAME_AGAIN[kind] : rule) {
    case "wait":
      return [await both()];
    case "ignore":
      return [await one()];
    case "beside":
      return [await both(), await outcomeOf([second, first])];
    case "replace":
      return [await other(), await both()];
  }
}

beforeAll(async () => {
  vi.useFakeTimers();
  vi.stubGlobal("Worker", FakeWorker);
  vi.stubGlobal("fetch", fetchSlowly);
  const heard = { addEventListener: () => {} };
  vi.stubGlobal("window", { ...heard, innerWidth: 1280, matchMedia: () => ({ ...heard, matches: false }) });
  const element = { style: { setProperty: () => {} }, dataset: {} };
  vi.stubGlobal("document", { baseURI: "http://localhost/", documentElement: element });
  vi.stubGlobal("navigator", { hardwareConcurrency: 2 });
  page = await pageModules();
  void page.start();
  await untilIdle();
});

afterAll(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("any two actions, the second while the first goes on", () => {
  it.each(NAMES)("%s, and then each", async (first) => {
    const failures: string[] = [];
    for (const second of NAMES) {
      for (const delay of DELAYS) {
        await beginAnew();
        begin(first);
        await vi.advanceTimersByTimeAsync(delay);
        const phase = page.phase.value;
        const isNothing = second === "undo" && !page.notices.value.some(({ action }) => action !== undefined);
        begin(second);
        await untilIdle();
        const found = outcome();
        const errors = page.notices.value.filter(({ severity }) => severity !== "info");
        const wrong = [...violations, ...errors.map(({ text }) => text)];
        const outcomes = isNothing ? [await outcomeOf([first])] : await allowed(first, second, phase);
        // Where a run was cut off, some stages are done, or outdated by a change.
        const isCut = phase !== null && (second === "cancel" || ACTIONS[second]?.[0] === "change");
        const shown = (all: object) => JSON.stringify(isCut ? { ...all, stages: [] } : all);
        if (wrong.length > 0 || !outcomes.map(shown).includes(shown(found))) {
          failures.push(`${first}, then ${second} after ${delay} ms (${phase}): ${wrong.join()}
            ${shown(found)} instead of
            ${outcomes.map(shown).join("\n            ")}`);
        }
      }
    }
    expect(failures).toEqual([]);
  });
});

describe("many actions", () => {
  it("in any order leave no error and a page that still runs", async () => {
    // The same order each time: a congruential generator.
    let seed = 38;
    const below = (count: number) => {
      seed = (seed * 1_103_515_245 + 12_345) % 2_147_483_648;
      return Math.floor((seed / 2_147_483_648) * count);
    };
    for (let round = 0; round < 60; round += 1) {
      await beginAnew();
      const order = Array.from({ length: 6 }, () => NAMES[below(NAMES.length)] as string);
      for (const name of order) {
        begin(name);
        await vi.advanceTimersByTimeAsync(below(60));
      }
      await untilIdle();
      const errors = page.notices.value.filter(({ severity }) => severity !== "info");
      const tooFew = errors.every(({ text }) => text.startsWith("fewer than three views"));
      expect([order, violations, tooFew]).toEqual([order, [], true]);
      begin("own files");
      await untilIdle();
      begin("run all");
      await untilIdle();
      expect([order, page.stages.value.map(({ status }) => status)]).toEqual([
        order,
        page.stages.value.map(() => "done"),
      ]);
    }
  });
});

describe("a run", () => {
  it("takes up parameters that are changed while it goes on", async () => {
    await beginAnew();
    begin("run all");
    await vi.advanceTimersByTimeAsync(120);
    expect(ran).toContain("matches");
    page.setParam("matching.window_px", 11);
    await untilIdle();
    expect(ran.filter((name) => name === "segments")).toHaveLength(1);
    expect(ran.filter((name) => name === "matches")).toHaveLength(2);
    expect(new Set(page.stages.value.map(({ status }) => status))).toEqual(new Set(["done"]));
  });

  it("shows a preliminary model until it has its own", async () => {
    await beginAnew();
    begin("run all");
    const seen = new Set<string>();
    for (let i = 0; i < 100 && !page.actions.isIdle; i += 1) {
      await vi.advanceTimersByTimeAsync(10);
      const facets = page.stages.value.find(({ name }) => name === "facets");
      if (page.preliminaryFacets.value !== null) {
        seen.add(facets?.status ?? "none");
        expect(page.mainResults.value.facets).toBeNull();
      }
    }
    expect(seen).toEqual(new Set(["waiting", "running"]));
    await untilIdle();
    expect(page.mainResults.value.facets).not.toBeNull();
  });

  it("that is over has no preliminary model, however late that comes", async () => {
    await beginAnew();
    const usual = TAKES.firstLook ?? 0;
    TAKES.firstLook = 5000;
    begin("run all");
    await untilIdle();
    // The same worker goes on with another project.
    begin("own files");
    await untilIdle();
    await vi.advanceTimersByTimeAsync(10_000);
    expect(page.preliminaryFacets.value).toBeNull();
    TAKES.firstLook = usual;
  });

  it("of the touched stage alone follows a parameter that is dragged, and the others when it is let go", async () => {
    await beginAnew();
    const path = "sweep.min_similarity";
    page.dragParam(path, 0.3);
    await page.dropParam(path);
    // Nothing had run.
    expect([ran, page.params.value]).toMatchObject([[], { sweep: { min_similarity: 0.3 } }]);
    begin("run all");
    await untilIdle();
    ran.length = 0;
    page.dragParam(path, 0.5);
    await vi.advanceTimersByTimeAsync(5);
    page.dragParam(path, 0.55);
    page.dragParam(path, 0.6);
    await untilIdle();
    // Values between the first and the last are left out.
    expect(ran).toEqual(["halfplanes", "halfplanes"]);
    void page.dropParam(path);
    await untilIdle();
    expect(ran.slice(2)).toEqual(["dense", "groups", "facets", "refinement", "corrections", "model"]);
    expect(new Set(page.stages.value.map(({ status }) => status))).toEqual(new Set(["done"]));
  });

  it("finds the matches again as long as views move", async () => {
    await beginAnew();
    moving.rounds = 2;
    begin("run all");
    await untilIdle();
    const times = (wanted: string) => ran.filter((name) => name === wanted).length;
    expect(["segments", "matches", "adjustment", "lines"].map(times)).toEqual([1, 3, 3, 1]);
    const last = [
      "matches",
      "adjustment",
      "lines",
      "ground",
      "halfplanes",
      "dense",
      "groups",
      "facets",
      "refinement",
      "corrections",
      "model",
    ];
    expect(ran.slice(-last.length)).toEqual(last);
    expect(new Set(page.stages.value.map(({ status }) => status))).toEqual(new Set(["done"]));
  });

  it("starts the core again when it stops, with the same files and parameters", async () => {
    await beginAnew();
    page.setParam("matching.window_px", 9);
    failing.set("matchedSegments", () => {
      throw new WebAssembly.RuntimeError("memory access out of bounds");
    });
    begin("run all");
    await untilIdle();
    const [notice] = page.notices.value;
    expect(notice).toMatchObject({ severity: "error", text: "Matches: memory access out of bounds" });
    expect(notice?.advice).not.toMatch(/smaller|fewer/);
    expect(page.stages.value.map(({ status }) => status).slice(0, 2)).toEqual(["done", "failed"]);
    expect(page.scene.value?.views).toHaveLength(5);
    page.dismissAbout("project");
    begin("run all");
    await untilIdle();
    expect(page.notices.value).toEqual([]);
    expect(page.stages.value.every(({ status }) => status === "done")).toBe(true);
    expect(page.params.value).toMatchObject({ matching: { window_px: 9 } });
  });

  it("speaks of memory where there was none left", async () => {
    await beginAnew();
    failing.set("load", () => {
      throw new WebAssembly.RuntimeError("unreachable");
    });
    begin("own files");
    await untilIdle();
    const errors = page.notices.value.filter(({ severity }) => severity === "error");
    expect(errors.map(({ title }) => title)).toEqual(["There is not enough memory"]);
    begin("own files");
    await untilIdle();
    expect(page.notices.value.map(({ severity }) => severity)).toEqual(["info"]);
  });
});

describe("steps", () => {
  const statuses = () => [...new Set(page.stages.value.map(({ status }) => status))];
  const path = "matching.window_px";

  it("are taken back and done again, with what was found before each", async () => {
    await beginAnew();
    begin("run all");
    await untilIdle();
    const found = page.allResults.value;
    page.setParam(path, 11);
    expect(statuses()).toEqual(["done", "outdated"]);
    await page.undo();
    // Nothing has run since: the core has it, too.
    expect([statuses(), page.freshStages.value]).toEqual([["done"], page.stages.value.length]);
    await page.redo();
    begin("run all");
    await untilIdle();
    ran.length = 0;
    await page.undo();
    expect([statuses(), page.params.value]).toMatchObject([["done"], { matching: { window_px: 15 } }]);
    expect(page.allResults.value).toEqual(found);
    expect(page.hasResults()).toBe(false);
    page.setParam(path, 11);
    expect([statuses(), ran]).toEqual([["done"], []]);
    // A file is computed by the stages that the core has of other parameters.
    page.setParam(path, 15);
    begin("save a file");
    await untilIdle();
    expect([ran.includes("segments"), ran.includes("matches")]).toEqual([false, true]);
  });

  it("over other files bring those back, and a view that was left out its result", async () => {
    await beginAnew();
    begin("run all");
    await untilIdle();
    const left = page.files.value.map(({ path }) => path).slice(0, 1);
    void page.setRunOptions({ leftOut: left });
    await untilIdle();
    expect(statuses()).toEqual(["outdated"]);
    void page.setRunOptions({ leftOut: [] });
    await untilIdle();
    expect(statuses()).toEqual(["done"]);
    begin("own files");
    await untilIdle();
    expect(page.files.value[0]?.path).toBe("own/0.jpg");
    void page.undo();
    await untilIdle();
    expect([page.files.value[0]?.path, statuses()]).toEqual(["base/0.jpg", ["done"]]);
    void page.redo();
    await untilIdle();
    expect([page.files.value[0]?.path, statuses()]).toEqual(["own/0.jpg", ["waiting"]]);
  });

  it("have one for all values of a parameter that is dragged", async () => {
    await beginAnew();
    for (const value of [0.3, 0.4, 0.5]) {
      page.dragParam("sweep.min_similarity", value);
    }
    await page.dropParam("sweep.min_similarity");
    const [before, last] = page.steps.value.slice(-2);
    expect([last?.about, before?.about]).toEqual(["sweep.min_similarity", "parameters"]);
  });

  it("keep results up to a limit, and drop the oldest", async () => {
    await beginAnew();
    begin("run all");
    await untilIdle();
    for (const value of [11, 13, 17]) {
      page.addResults("model", { glb: new Uint8Array(150e6) });
      page.setParam(path, value);
      begin("run all");
      await untilIdle();
    }
    page.setParam(path, 13);
    expect(statuses()).toEqual(["done"]);
    page.setParam(path, 15);
    expect(statuses()).toEqual(["done", "outdated"]);
  });
});

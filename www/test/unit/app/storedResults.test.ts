/** Results that are shown again without a run. */
import { beforeEach, describe, expect, it, vi } from "vitest";
import { asTree } from "../../../src/shared/paramTree";
import { FACETS, Session } from "../../fake/ridgeline";

vi.mock("../../../src/pkg/ridgeline_bg.wasm?url", () => ({ default: "none" }));

const stored = await import("../../../src/app/session/storedResults");
const { allResults, addResults, exportNames, NO_RESULTS, setExportNames, setResults } = await import(
  "../../../src/app/state/results"
);
const stages = await import("../../../src/app/state/stages");
const { params, replaceParams, setDefaults } = await import("../../../src/app/state/parameters");
const { withParam } = await import("../../../src/app/settings/parameterForm");

const DEFAULTS = asTree(Session.defaultParams());
const FOUND = {
  segments: [Float32Array.from([1, 2.5, 3, 4])],
  lines: Float64Array.from([0.1, 1 / 3, 5, 6, 7, 8]),
  glb: Uint8Array.from({ length: 70_000 }, (_, i) => i % 251),
  facets: FACETS,
};

function closePage(): void {
  setResults(NO_RESULTS);
  setExportNames([]);
  stages.restartStages();
}

describe("stored results", () => {
  beforeEach(() => {
    setDefaults(DEFAULTS);
    replaceParams(DEFAULTS);
    stages.replaceStages(["lines", "model"]);
    closePage();
    addResults("model", FOUND);
    setExportNames(["model.glb"]);
    stages.updateStage("lines", { status: "done", counts: { lines: 1 } });
    stages.updateStage("model", { status: "done" });
  });

  it("are shown as they were, from a file as well", () => {
    const before = stored.presentResults();
    if (before === null) throw new Error("there are results");
    const bytes = stored.packResults(before);
    closePage();
    expect(stored.presentResults()).toBeNull();
    const read = stored.unpackResults(bytes);
    if (read === null) throw new Error("they can be read");
    stored.showStoredResults(read);
    expect(allResults.value.main).toEqual({ ...NO_RESULTS, ...FOUND });
    expect(allResults.value.main.lines).toBeInstanceOf(Float64Array);
    expect(exportNames.value).toEqual(["model.glb"]);
    expect(stages.stages.value.map(({ status }) => status)).toEqual(["done", "done"]);
    expect(stages.freshStages.value).toBe(0);
  });

  it("are outdated under other parameters, and nothing of another core or method", () => {
    const kept = stored.presentResults();
    if (kept === null) throw new Error("there are results");
    closePage();
    replaceParams(withParam(params.value, "matching.window_px", 11));
    stored.showStoredResults(kept);
    expect(stages.stages.value.map(({ status }) => status)).toEqual(["outdated", "outdated"]);
    closePage();
    stored.showStoredResults({ ...kept, core: "an older one" });
    expect(stored.presentResults()).toBeNull();
    stages.replaceStages(["rectangles", "model"]);
    stored.showStoredResults(kept);
    expect(allResults.value.main.glb).toBeNull();
  });

  it.each(["", "{}", "[1", '{"core": {"$bytes": 3}, "results": 1}'])("are not read from %j", (text) => {
    expect(stored.unpackResults(new TextEncoder().encode(text))).toBeNull();
  });
});

import { afterEach, describe, expect, it } from "vitest";
import {
  addResults,
  mainResults,
  NO_RESULTS,
  params,
  results,
  setResults,
  tab,
} from "../../src/app/state/state";

const choose = (method: string) => {
  params.value = { method } as unknown as typeof params.value;
};

afterEach(() => {
  params.value = {};
  tab.value = "images";
  setResults(NO_RESULTS);
});

describe("results", () => {
  it("of both methods stand side by side, and a tab tells of its own", () => {
    choose("combined");
    const [clustered, matched] = [new Float64Array(6), new Float64Array(12)];
    addResults("clusters", { lines: clustered });
    addResults("lines", { lines: matched });
    for (const name of ["regions", "directions", "clusters", "rectangles"] as const) {
      tab.value = name;
      expect(results.value.lines).toBe(clustered);
    }
    for (const name of ["segments", "lines", "facets", "model"] as const) {
      tab.value = name;
      expect(results.value.lines).toBe(matched);
    }
    expect(mainResults.value.lines).toBe(matched);
  });

  it("of one method are all in one place", () => {
    choose("rectangles");
    const lines = new Float64Array(6);
    addResults("clusters", { lines });
    tab.value = "model";
    expect(results.value.lines).toBe(lines);
    expect(mainResults.value.lines).toBe(lines);
  });
});

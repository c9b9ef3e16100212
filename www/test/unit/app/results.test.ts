import { afterEach, describe, expect, it } from "vitest";
import { type params, replaceParams } from "../../../src/app/state/parameters";
import {
  addResults,
  mainResults,
  NO_RESULTS,
  preliminaryFacets,
  results,
  setResults,
  showPreliminary,
} from "../../../src/app/state/results";
import { showFace, showTab } from "../../../src/app/state/viewState";
import type { Facet } from "../../../src/shared/records";

showFace("method");

const choose = (method: string) => {
  replaceParams({ method } as unknown as typeof params.value);
};

afterEach(() => {
  replaceParams({});
  showTab("images");
  setResults(NO_RESULTS);
});

describe("results", () => {
  it("of both methods stand side by side, and a tab tells of its own", () => {
    choose("combined");
    const [clustered, matched] = [new Float64Array(6), new Float64Array(12)];
    addResults("clusters", { lines: clustered });
    addResults("lines", { lines: matched });
    for (const name of ["regions", "directions", "clusters", "rectangles"] as const) {
      showTab(name);
      expect(results.value.lines).toBe(clustered);
    }
    for (const name of ["segments", "lines", "facets", "model"] as const) {
      showTab(name);
      expect(results.value.lines).toBe(matched);
    }
    expect(mainResults.value.lines).toBe(matched);
  });

  it("of one method are all in one place", () => {
    choose("rectangles");
    const lines = new Float64Array(6);
    addResults("clusters", { lines });
    showTab("model");
    expect(results.value.lines).toBe(lines);
    expect(mainResults.value.lines).toBe(lines);
  });

  it("have no preliminary facets among them, and take their place", () => {
    const first = [{ outer: [] }] as unknown as Facet[];
    showPreliminary(first);
    expect(preliminaryFacets.value).toBe(first);
    expect(results.value.facets).toBeNull();
    addResults("lines", { lines: new Float64Array(6) });
    expect(preliminaryFacets.value).toBe(first);
    addResults("facets", { facets: [] });
    expect(preliminaryFacets.value).toBeNull();
    showPreliminary(null);
  });
});

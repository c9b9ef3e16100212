import { afterEach, describe, expect, it } from "vitest";
import { facetRejectionWords } from "../../../src/app/parts/reasonText";
import { NO_RESULTS, type Results, restoreResults, results } from "../../../src/app/state/results";
import { showFace, showTab } from "../../../src/app/state/viewState";
import { rowsOf } from "../../../src/kinds/kinds";
import { evidenceRow } from "../../../src/kinds/parts/evidenceRows";
import type { Bars, Row } from "../../../src/kinds/parts/rows";
import type { Evidence, Facet, FacetTrace, LineRecord } from "../../../src/shared/records";
import { presentEntries } from "../../../src/stages/PageLegend";
import { about } from "../kinds/about";

showFace("method");

const evidence = (prior: number, terms: Record<string, [value: number, nats: number]>): Evidence => ({
  prior,
  terms: Object.entries(terms).map(([feature, [value, nats]]) => ({ feature, value, nats })),
});

const BY_VIEWS = evidence(3.045, { missing_views: [4, -0.84], slope_deg: [0, 0.5] });
const IN_MODEL = evidence(3.3, { nats_before: [2, -0.9], is_border: [1, -1.3], is_intersection: [0, 0.02] });
const AGAINST = evidence(-1, { excess_green: [0.1, -1.67], cos_slope: [1, 0.9], correlation: [0, -0.25] });

const line = (of: Partial<LineRecord>): LineRecord => ({
  origin: "matched",
  contradiction: null,
  probability: 0.934,
  by_views: null,
  in_model: null,
  sigma_m: 0.01,
  covariance: [
    [0, 0, 0, 0, 0, 0],
    [0, 0, 0, 0, 0, 0],
  ],
  supports: [],
  ...of,
});
const facet = (probability: number) =>
  ({
    building: 0,
    plane: { normal: [0, 0, 1], d: 0 },
    outer: [],
    holes: [],
    similarity: 0.8,
    probability,
  }) as unknown as Facet;

function show(found: Partial<Results>): void {
  restoreResults({ main: { ...NO_RESULTS, ...found }, regions: NO_RESULTS });
}

const valueIn = (rows: readonly Row[], label: string) => rows.find(([name]) => name === label)?.[1];

const lineRows = (of: Partial<LineRecord>) => {
  show({ lines: Float64Array.of(0, 0, 0, 1, 0, 0), records: [line(of)] });
  return rowsOf({ kind: "line", index: 0 }, about(results.value));
};

afterEach(() => {
  showTab("images");
  show({});
});

describe("the rows of a line", () => {
  it("have its probability and a bar for the prior and for each term, with its sign", () => {
    const rows = lineRows({ by_views: BY_VIEWS, in_model: IN_MODEL });
    expect(valueIn(rows, "Probability")).toBe("93 %");
    expect(valueIn(rows, "For and against it, by its views (nats)")).toEqual({
      bars: [
        { name: "prior odds", nats: 3.045 },
        { name: "views that see it and do not show it", nats: -0.84 },
        { name: "slope", nats: 0.5 },
      ],
    });
  });

  it("leave out what it is not, where a feature is 1 or 0", () => {
    const rows = lineRows({ by_views: BY_VIEWS, in_model: IN_MODEL });
    expect(valueIn(rows, "For and against it, in the model (nats)")).toEqual({
      bars: [
        { name: "prior odds", nats: 3.3 },
        { name: "what its views said", nats: -0.9 },
        { name: "border of a facet", nats: -1.3 },
      ],
    });
  });

  it("state no probability where nothing weighed it, and have no bars in results without evidence", () => {
    const { by_views: _, in_model: __, ...old } = line({});
    expect(valueIn(lineRows({ probability: 1 }), "Probability")).toBe("–");
    expect(valueIn(lineRows({ probability: 0.998, by_views: BY_VIEWS }), "Probability")).toBe("> 99 %");
    show({ lines: Float64Array.of(0, 0, 0, 1, 0, 0), records: [old as LineRecord] });
    expect(
      rowsOf({ kind: "line", index: 0 }, about(results.value)).filter(([name]) => name.startsWith("For")),
    ).toEqual([]);
    expect(evidenceRow("any", undefined)).toBeNull();
  });

  it("say why the model contradicts it", () => {
    expect(valueIn(lineRows({ contradiction: "improbable" }), "Contradicted")).toBe(
      "too unlikely an edge in this model",
    );
  });
});

it("a facet has its probability, unless nothing weighed it", () => {
  show({ facets: [facet(0.87), facet(1)] });
  expect(valueIn(rowsOf({ kind: "facet", index: 0 }, about(results.value)), "Probability")).toBe("87 %");
  expect(valueIn(rowsOf({ kind: "facet", index: 1 }, about(results.value)), "Probability")).toBe("–");
});

it("a rejected facet says in short why, and in bars all that was weighed", () => {
  const reason = { improbable: { evidence: AGAINST } };
  const verification = { rejected: [{ group: 0, outline: [], reason }] } as unknown as FacetTrace;
  show({ verification });
  const words = facetRejectionWords(reason);
  expect(words).toBe("more likely no roof (probability 12 %); most against it: excess green (−1.7 nats)");
  const rows = rowsOf({ kind: "rejectedFacet", index: 0 }, about(results.value));
  expect(valueIn(rows, "Rejected")).toBe(words);
  const { bars } = valueIn(rows, "For and against it (nats)") as Bars;
  expect(bars.map(({ nats }) => nats)).toEqual([-1, -1.67, 0.9, -0.25]);
});

it("a place that may be roof and has no facet says why, and how likely it is", () => {
  const seen = { outline: [], area_m2: 24.04, probability: 0.62 };
  const why = { rejected: { facet: 3, evidence: AGAINST } };
  show({
    uncovered: [
      { ...seen, why },
      { ...seen, why: "no_plane" },
    ],
  });
  const rowsOfRoof = (index: number) => rowsOf({ kind: "uncoveredRoof", index }, about(results.value));
  expect(valueIn(rowsOfRoof(0), "Rejected as improbable")).toEqual([
    { name: "4", selection: { kind: "rejectedFacet", index: 3 } },
  ]);
  expect((valueIn(rowsOfRoof(0), "For and against it (nats)") as Bars).bars).toHaveLength(4);
  expect(valueIn(rowsOfRoof(1), "No facet, because")).toBe("no plane won the place");
  expect(valueIn(rowsOfRoof(1), "Probability of a roof")).toBe("62 %");
  expect(valueIn(rowsOfRoof(1), "Area in plan")).toBe("24.0 m²");
});

it("a facet that does not stand above the ground says by how much", () => {
  expect(facetRejectionWords({ near_ground: { height_m: 0.84 } })).toBe(
    "lower than any eave (its middle 0.8 m above the ground)",
  );
  expect(facetRejectionWords({ reaches_ground: { lowest_m: 0.31 } })).toBe(
    "its low side is lower than any eave (0.3 m above the ground)",
  );
});

describe("the legend", () => {
  const entries = () => presentEntries().map(([, meaning]) => meaning);

  it("says what faint means only where something is", () => {
    showTab("lines");
    show({ records: [line({})] });
    expect(entries()).not.toContain("faint: less certain");
    show({ records: [line({}), line({ probability: 0.6 })] });
    expect(entries()).toContain("faint: less certain");
    show({ records: [line({ probability: 0.3, contradiction: "improbable" })] });
    expect(entries()).not.toContain("faint: less certain");
    showTab("facets");
    show({ facets: [facet(0.95)] });
    expect(entries()).not.toContain("faint: less certain");
    show({ facets: [facet(0.95), facet(0.7)] });
    expect(entries()).toContain("faint: less certain");
  });
});

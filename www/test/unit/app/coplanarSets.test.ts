/** What the page says of sets of coplanar lines, and of what they proposed. */
import { afterEach, describe, expect, it } from "vitest";
import { setAt, shownSets } from "../../../src/app/selection/coplanarPlan";
import { NO_RESULTS, restoreResults, results } from "../../../src/app/state/results";
import { showFace, showTab } from "../../../src/app/state/viewState";
import { linesOf, rowsOf, shapesOf, titleOf } from "../../../src/kinds/kinds";
import type { Related, Row } from "../../../src/kinds/parts/rows";
import {
  type CoplanarSet,
  type CoplanarSets,
  coplanarSetsOf,
  type Facet,
  type GroupingTrace,
  isMadeFrom,
} from "../../../src/shared/records";
import { tabsOf } from "../../../src/stages/catalogue";
import { coplanarSetParts } from "../../../src/stages/coplanar/tour";
import { presentEntries } from "../../../src/stages/PageLegend";
import { about } from "../kinds/about";

showFace("method");

const square = (x: number, side: number): CoplanarSet["polygon"] => [
  [x, 0, 5],
  [x + side, 0, 5],
  [x + side, side, 5],
  [x, side, 5],
];
const set = (of: Partial<CoplanarSet>): CoplanarSet => ({
  lines: [3, 4],
  plane: { normal: [0, 0, 1], d: -5 },
  covariance: [
    [4e-4, 0, 0],
    [0, 1e-4, 0],
    [0, 0, 1e-4],
  ],
  hull: square(0, 3),
  polygon: square(0, 4),
  coplanar_nats: 4,
  inside_nats: 30,
  outline_nats: -12,
  ...of,
});
const trace = (closing: CoplanarSets["trace"]["sets"][number]["closing"]) => ({
  closing,
});
/** The second is not verified; the third lies over the first, and says less. */
const COPLANAR: CoplanarSets = {
  sets: [
    set({}),
    set({ inside_nats: 5, polygon: square(8, 4) }),
    set({ lines: [7], inside_nats: 14, polygon: square(0, 6) }),
  ],
  trace: {
    sets: [
      trace([
        {
          segment: [
            [0, 0, 5],
            [0, 4, 5],
          ],
          kind: "square",
          nats: 1.5,
        },
      ]),
      trace([]),
      trace([]),
    ],
  },
};
const FACET = {
  plane: { normal: [0, 0, 1], d: -5 },
  half_planes: [],
  proposals: [{ coplanar_set: 0 }],
  similarity: 0.8,
  real_ratio: 1,
  outer: [],
  holes: [],
} as unknown as Facet;

function show(): void {
  const grouping = { groups: [] } as unknown as GroupingTrace;
  const main = { ...NO_RESULTS, coplanar: COPLANAR, grouping, facets: [FACET] };
  restoreResults({ main, regions: NO_RESULTS });
}

afterEach(() => {
  showTab("images");
  restoreResults({ main: NO_RESULTS, regions: NO_RESULTS });
});

const valueIn = (rows: readonly Row[], label: string) => rows.find(([name]) => name === label)?.[1];
const barsIn = (rows: readonly Row[], label: string) => {
  const value = valueIn(rows, label);
  return typeof value === "object" && "bars" in value ? value.bars.map(({ nats }) => nats) : [];
};

describe("sets of coplanar lines", () => {
  it("are told with their nats and what became of them", () => {
    show();
    expect(titleOf({ kind: "coplanar", index: 0 }, about(results.value))).toBe("Coplanar set 1");
    const rows = rowsOf({ kind: "coplanar", index: 0 }, about(results.value));
    expect(valueIn(rows, "Verified")).toBe("yes");
    expect(barsIn(rows, "For and against it (nats)")).toEqual([4, 30, -12]);
    expect(barsIn(rows, "Sides without a line (nats)")).toEqual([1.5]);
    const names = (label: string) => (valueIn(rows, label) as Related[]).map(({ name }) => name);
    expect(names("3D lines")).toEqual(["4", "5"]);
    expect(names("Facets")).toEqual(["1"]);
    expect(valueIn(rowsOf({ kind: "coplanar", index: 1 }, about(results.value)), "Verified")).toBe("no");
    expect(rowsOf({ kind: "coplanar", index: 9 }, about(results.value))).toEqual([]);
    expect(valueIn(rowsOf({ kind: "facet", index: 0 }, about(results.value)), "Coplanar sets")).toMatchObject(
      [{ name: "1" }],
    );
  });

  it("light up with the hull that was there before", () => {
    show();
    const shapes = shapesOf({ kind: "coplanar", index: 0 }, results.value);
    expect(shapes.map(({ role }) => role)).toEqual(["before", "area"]);
    expect(shapes[1]?.points).toEqual(square(0, 4));
    expect(linesOf({ kind: "coplanar", index: 0 }, results.value)).toEqual([3, 4]);
    expect(shapesOf({ kind: "coplanar", index: 9 }, results.value)).toEqual([]);
  });

  it("are picked in plan: of several the smallest, and the largest lie below", () => {
    expect(shownSets(COPLANAR, null)).toEqual([2, 0]);
    expect(shownSets(COPLANAR, 1)).toEqual([2, 0, 1]);
    expect(setAt(COPLANAR, [1, 1])).toBe(0);
    expect(setAt(COPLANAR, [5, 5])).toBe(2);
    expect(setAt(COPLANAR, [9, 1])).toBeNull();
  });

  it("propose planes", () => {
    expect(coplanarSetsOf(FACET)).toEqual([0]);
    expect(isMadeFrom(FACET, { members: [], proposals: [{ coplanar_set: 0 }] })).toBe(true);
    expect(isMadeFrom(FACET, { members: [], proposals: [{ coplanar_set: 1 }] })).toBe(false);
  });

  it("have a tab and a legend", () => {
    show();
    showTab("coplanar");
    expect(presentEntries().map(([colour]) => colour)).toEqual(["grown", "set", "unmatched"]);
    expect(tabsOf("coplanar")).toContain("coplanar");
    expect(tabsOf("coplanar")).not.toContain("halfplanes");
  });

  it("are a step of the tour where a side was moved", () => {
    expect(coplanarSetParts({ coplanar: COPLANAR, facets: [FACET] }, 0)).toEqual({
      lines: 2,
      moved: 1,
      facets: [0],
    });
    expect(coplanarSetParts({ coplanar: COPLANAR, facets: [FACET] }, 1)?.moved).toBe(0);
    expect(coplanarSetParts({ coplanar: COPLANAR, facets: [FACET] }, 5)).toBeNull();
  });
});

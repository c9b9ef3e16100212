/** What the page says of the planes of dense matching, and of what they proposed. */
import { afterEach, describe, expect, it } from "vitest";
import { frameOf } from "../../../src/app/parts/charts";
import { areasOf, equalScales, planeAt, squaresAt } from "../../../src/app/selection/densePlan";
import { NO_RESULTS, restoreResults, results } from "../../../src/app/state/results";
import { showFace, showTab } from "../../../src/app/state/viewState";
import { rowsOf, shapesOf, titleOf } from "../../../src/kinds/kinds";
import type { Related, Row } from "../../../src/kinds/parts/rows";
import {
  type DensePlane,
  type DensePlanes,
  densePlanesOf,
  type Facet,
  type GroupingTrace,
  isMadeFrom,
  rectanglesOf,
} from "../../../src/shared/records";
import { formatSelection } from "../../../src/shared/selection";
import { slopeSigma } from "../../../src/shared/surfaceClass";
import { methodOfFacet } from "../../../src/stages/model/ModelModes";
import { presentEntries } from "../../../src/stages/PageLegend";
import { about } from "../kinds/about";

showFace("method");

const RING: DensePlane["ring"] = [
  [0, 0, 5],
  [2, 0, 5],
  [2, 1, 5],
  [0, 1, 5],
];
const plane = (of: Partial<DensePlane>): DensePlane => ({
  plane: { normal: [0, 0, 1], d: -5 },
  covariance: [
    [4e-4, 0, 0],
    [0, 1e-4, 0],
    [0, 0, 1e-4],
  ],
  ring: RING,
  patches: [],
  area_m2: 2,
  rms_m: 0.034,
  class: { building: 0.97, ground: 0.02, vegetation: 0.01 },
  ...of,
});
const evidence = (nats: number) => ({ prior: 0.5, terms: [{ feature: "height_m", value: 5, nats }] });
/** Patches 0 to 4 in a row; 0 and 1 are of a building, 2 and 3 of a hedge, 4 is in no plane. */
const DENSE: DensePlanes = {
  planes: [
    plane({ patches: [0, 1] }),
    plane({ patches: [2, 3], class: { building: 0.1, ground: 0.3, vegetation: 0.6 } }),
  ],
  trace: {
    patches: [0, 1, 2, 3, 4].map((x) => ({
      middle: [x, 0],
      z: 5,
      gradient: [0, 0],
      correlation: 0.5 + 0.1 * x,
      weight: 1,
    })),
    classes: [3, -2].map((nats) => ({ building: evidence(nats), vegetation: evidence(-nats) })),
    spacing_m: 1,
  },
};
const proposedBy = (...proposals: Facet["proposals"]) =>
  ({
    plane: { normal: [0, 0, 1], d: -5 },
    outer: [],
    holes: [],
    similarity: 0.8,
    half_planes: [],
    proposals,
  }) as unknown as Facet;
const GROUPING = {
  groups: [
    { plane: { normal: [0, 0, 1], d: -5 }, members: [], proposals: [{ dense_plane: 0 }] },
    {
      plane: { normal: [0, 0, 1], d: 0 },
      members: [{ line: 0, side: "left", half_plane: 4 }],
      proposals: [],
    },
  ],
} as unknown as GroupingTrace;

function show(): void {
  restoreResults({
    main: {
      ...NO_RESULTS,
      dense: DENSE,
      grouping: GROUPING,
      facets: [proposedBy({ dense_plane: 0 })],
    },
    regions: NO_RESULTS,
  });
}

afterEach(() => {
  showTab("images");
  restoreResults({ main: NO_RESULTS, regions: NO_RESULTS });
});

const valueIn = (rows: readonly Row[], label: string) => rows.find(([name]) => name === label)?.[1];
const linked = (rows: readonly Row[], label: string) =>
  (valueIn(rows, label) as readonly Related[]).map(({ selection }) => formatSelection(selection));

describe("proposals", () => {
  it("are of two kinds", () => {
    const both = proposedBy({ rectangle: 3 }, { dense_plane: 5 }, { rectangle: 7 });
    expect(rectanglesOf(both)).toEqual([3, 7]);
    expect(densePlanesOf(both)).toEqual([5]);
  });

  it("tie a facet to its group as half-planes do, each kind for itself", () => {
    const group = { members: [], proposals: [{ dense_plane: 3 }] };
    expect(isMadeFrom(proposedBy({ dense_plane: 3 }), group)).toBe(true);
    expect(isMadeFrom(proposedBy({ rectangle: 3 }), group)).toBe(false);
    const byLines = { members: [{ line: 0, side: "left" as const, half_plane: 4 }], proposals: [] };
    expect(isMadeFrom({ half_planes: [4], proposals: [] }, byLines)).toBe(true);
    expect(isMadeFrom({ half_planes: [3], proposals: [] }, byLines)).toBe(false);
  });

  it("count dense planes to the method of lines", () => {
    expect(methodOfFacet(proposedBy({ dense_plane: 0 }), "combined")).toBe("lines");
    expect(methodOfFacet(proposedBy({ rectangle: 0 }), "combined")).toBe("rectangles");
    expect(methodOfFacet(proposedBy({ rectangle: 0 }, { dense_plane: 0 }), "combined")).toBe("combined");
    expect(methodOfFacet(proposedBy({ dense_plane: 0 }), "lines")).toBe("lines");
  });
});

describe("the inspector", () => {
  it("says of a dense plane what it is, how sure its place is, and what it proposed", () => {
    show();
    const rows = rowsOf({ kind: "dense", index: 0 }, about(results.value));
    expect(titleOf({ kind: "dense", index: 0 }, about(results.value))).toBe("Dense plane 1");
    expect(valueIn(rows, "It is")).toBe("building 97 %, ground 2 %, vegetation 1 %");
    expect(valueIn(rows, "σ of its height")).toBe("2.0 cm");
    expect(valueIn(rows, "RMS of its patches")).toBe("3.4 cm");
    expect(valueIn(rows, "Mean correlation")).toBe("0.55");
    expect(valueIn(rows, "For and against a building (nats)")).toEqual({
      bars: [
        { name: "prior odds", nats: 0.5 },
        { name: "height above the ground", nats: 3 },
      ],
    });
    expect(linked(rows, "Groups")).toEqual(["group:0"]);
    expect(linked(rows, "Facets")).toEqual(["facet:0"]);
    expect(linked(rowsOf({ kind: "dense", index: 1 }, about(results.value)), "Facets")).toEqual([]);
    expect(rowsOf({ kind: "dense", index: 9 }, about(results.value))).toEqual([]);
  });

  it("leads from groups and facets to their dense planes", () => {
    show();
    expect(linked(rowsOf({ kind: "group", index: 0 }, about(results.value)), "Dense planes")).toEqual([
      "dense:0",
    ]);
    expect(linked(rowsOf({ kind: "facet", index: 0 }, about(results.value)), "Dense planes")).toEqual([
      "dense:0",
    ]);
    expect(
      valueIn(rowsOf({ kind: "group", index: 1 }, about(results.value)), "Dense planes"),
    ).toBeUndefined();
  });

  it("has the slope's deviation along the slope", () => {
    const covariance: DensePlane["covariance"] = [
      [1, 0, 0],
      [0, 0.04, 0.01],
      [0, 0.01, 0.09],
    ];
    const tilted = (x: number, y: number) => {
      const length = Math.hypot(x, y, 1);
      return { plane: { normal: [-x / length, -y / length, 1 / length], d: 0 }, covariance } as Pick<
        DensePlane,
        "plane" | "covariance"
      >;
    };
    // The angle is the arc tangent of the rise: its deviation is that of the rise over 1 + rise².
    expect(slopeSigma(tilted(1, 0))).toBeCloseTo(0.2 / 2, 9);
    expect(slopeSigma(tilted(0, 2))).toBeCloseTo(0.3 / 5, 9);
    expect(slopeSigma(tilted(1, 1))).toBeCloseTo(Math.sqrt((0.04 + 0.02 + 0.09) / 2) / 3, 9);
    expect(slopeSigma(tilted(0, 0))).toBeCloseTo(0.3, 9);
  });
});

it("a dense plane is shown by its ring, as is a group that no line made", () => {
  show();
  const area = [{ points: RING, role: "area" }];
  expect(shapesOf({ kind: "dense", index: 0 }, results.value)).toEqual(area);
  expect(shapesOf({ kind: "group", index: 0 }, results.value)).toEqual(area);
});

it("the legend names the classes that there are", () => {
  showTab("dense");
  expect(presentEntries()).toEqual([]);
  show();
  expect(presentEntries().map(([, meaning]) => meaning)).toEqual([
    "building",
    "vegetation",
    "small: in no plane",
    "faint: less certain",
  ]);
});

describe("the plan", () => {
  it("draws patches that look alike as one, by class or by the probability of a building", () => {
    expect(areasOf(DENSE, "class")).toEqual([
      { name: "building", opacity: 1, own: [0, 1] },
      { name: "vegetation", opacity: 0.6, own: [2, 3] },
    ]);
    expect(areasOf(DENSE, "building")).toEqual([
      { name: "building", opacity: 1, own: [0, 1] },
      { name: "building", opacity: 0.1, own: [2, 3] },
    ]);
    expect(squaresAt([[1, 2]], 1)).toBe("M0.3 1.3h1.40v1.40h-1.40z");
  });

  it("finds the plane at a place", () => {
    expect([0.2, 2.6, 4.1, 8].map((x) => planeAt(DENSE, [x, 0.3]))).toEqual([0, 1, null, null]);
  });

  it("has metres of one size in both directions, and room for all", () => {
    const frame = frameOf(450, 240);
    const places: [number, number][] = [
      [0, 0],
      [10, 90],
    ];
    const [x, y] = equalScales(frame, places, 1);
    expect((x.max - x.min) / 400).toBeCloseTo((y.max - y.min) / 200, 9);
    expect([y.min, y.max]).toEqual([-1, 91]);
    expect((x.min + x.max) / 2).toBeCloseTo(5, 9);
  });
});

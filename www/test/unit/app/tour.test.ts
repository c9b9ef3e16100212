/** What the tour shows is chosen so that what it says of it is so. */
import { describe, expect, it } from "vitest";
import { counted } from "../../../src/app/parts/counted";
import type { Results } from "../../../src/app/state/results";
import type { SideTrace } from "../../../src/shared/records";
import { densePlaneParts } from "../../../src/stages/dense/tour";
import { groupParts } from "../../../src/stages/groups/tour";
import { agreesNowhere, fallOf, roofEnds, slopedHalfPlanes } from "../../../src/stages/halfplanes/tour";
import { growthOf } from "../../../src/stages/lines/tour";
import { roofSegments } from "../../../src/stages/matches/tour";
import { facetOfSegment } from "../../../src/stages/segments/tour";

const DEGREE = Math.PI / 180;

/** A kerb of 500 px (line 0), an eave of 90 px (line 1) at facet 0, and a rake of 70 px (line 2) at facet 1. */
const RESULTS = {
  segments: [Float32Array.from([0, 0, 500, 0, 0, 0, 70, 0, 0, 0, 0, 90])],
  records: [0, 2, 1].map((segment) => ({ supports: [{ view: 0, segments: [segment] }] })),
  facets: [
    { lines: [1], half_planes: [0] },
    { lines: [2], half_planes: [1] },
  ],
  halfPlanes: [
    { line: 1, side: "left", theta: 30 * DEGREE },
    { line: 2, side: "left", theta: 5 * DEGREE },
    { line: 0, side: "left", theta: 40 * DEGREE },
  ],
  sides: [
    { line: 0, side: "right", rejection: "low_peak" },
    { line: 1, side: "right", rejection: "low_peak" },
    { line: 2, side: "right", rejection: "improbable" },
  ],
  grouping: {
    groups: [
      {
        members: [
          { line: 1, side: "left", half_plane: 0 },
          { line: 1, side: "right", half_plane: null },
          { line: 2, side: "left", half_plane: null },
        ],
        proposals: [],
      },
      { members: [{ line: 0, side: "left", half_plane: 2 }], proposals: [] },
    ],
  },
  lines: Float64Array.from([0, 0, 0, 0, 9, 0, 0, 0, 0, 4, 3, 0]),
  stretches: Float64Array.from([1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 8, 0, 0]),
} as unknown as Results;

function curve(at: (degrees: number) => number): SideTrace {
  const thetas = Array.from({ length: 31 }, (_, i) => (-75 + 5 * i) * DEGREE);
  return {
    rejection: null,
    curve: { thetas, similarity: thetas.map((one) => at(one / DEGREE)) },
  } as SideTrace;
}

describe("the tour's examples", () => {
  it("leave out the kerb, though it is the longest segment", () => {
    expect(roofSegments(RESULTS, 0)).toEqual([2, 1]);
    expect([0, 1, 2].map((segment) => facetOfSegment(RESULTS, 0, segment))).toEqual([null, 1, 0]);
  });

  it("say by how much a line grew beyond its longest piece", () => {
    expect(growthOf(RESULTS, 1)).toEqual({ before: 2, after: 5 });
  });

  it("take half-planes that became facets and are not level", () => {
    expect(slopedHalfPlanes(RESULTS).map(({ line }) => line)).toEqual([1]);
  });

  it("turn to where Sim is lowest in reach of the peak, and know a second peak from a fall", () => {
    const sharp = fallOf(
      curve((theta) => (Math.abs(theta - 20) < 6 ? 0.8 : theta < -15 ? 0.05 : 0.2)),
      20 * DEGREE,
    );
    expect(sharp.at / DEGREE).toBeCloseTo(-25, 6);
    expect(sharp.by).toBeCloseTo(0.75, 6);
    expect(
      fallOf(
        curve((theta) => (Math.abs(theta) < 80 ? 0.8 : 0)),
        20 * DEGREE,
      ).by,
    ).toBe(0);
  });

  it("show a roof's end by a side that was rejected because its peak is low", () => {
    expect(roofEnds(RESULTS).map(({ line }) => line)).toEqual([1]);
    expect(agreesNowhere({ rejection: "low_peak" })).toBe(true);
    expect(agreesNowhere({ rejection: "improbable" })).toBe(false);
  });

  it("know the facet of a group, and that a group of the ground has none", () => {
    expect(groupParts(RESULTS, 0)).toEqual({ lines: 2, facets: [0] });
    expect(groupParts(RESULTS, 1)).toEqual({ lines: 1, facets: [] });
  });
});

it("a dense plane is told with the facets that it proposed, and their half-planes", () => {
  const of = (building: number) => ({
    class: { building, ground: 0, vegetation: 1 - building },
    patches: [0, 1],
    rms_m: 0.05,
  });
  const all = {
    dense: { planes: [of(0.8), of(0.3)] },
    facets: [{ proposals: [{ dense_plane: 0 }, { rectangle: 1 }], half_planes: [4, 5] }, { proposals: [] }],
  } as unknown as Results;
  expect(densePlaneParts(all, 0)).toEqual({
    name: "building",
    probability: 0.8,
    patches: 2,
    rmsM: 0.05,
    facets: [0],
    halfPlanes: 2,
  });
  expect(densePlaneParts(all, 1)).toMatchObject({ name: "vegetation", facets: [], halfPlanes: 0 });
  expect(densePlaneParts(all, 2)).toBeNull();
});

describe("counted", () => {
  it("knows one from many", () => {
    expect(counted(1, "segments")).toBe("1 segment");
    expect(counted(1952, "segments")).toBe("1,952 segments");
    expect(counted(1, "pairs of directions")).toBe("1 pair of directions");
    expect(counted(0, "matches")).toBe("0 matches");
    expect(counted(1, "matches")).toBe("1 match");
    expect(counted(1, "patches")).toBe("1 patch");
  });
});

describe("the tour", () => {
  it("goes through B99, its other ways to planes, and W96 at the end", async () => {
    const { STEPS } = await import("../../../src/app/tour/steps");
    expect(STEPS.map(({ method, tab }) => `${method} ${tab}`)).toEqual([
      "lines segments",
      "lines matches",
      "lines matches",
      "lines lines",
      "lines halfplanes",
      "lines halfplanes",
      "lines dense",
      "lines groups",
      "lines model",
      "coplanar coplanar",
      "adjacency adjacency",
      "rectangles clusters",
    ]);
  });
});

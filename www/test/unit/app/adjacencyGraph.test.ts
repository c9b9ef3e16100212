/** What the page says of adjacency graphs: corners of an image, corners in space, and the planes that these propose. */
import { afterEach, describe, expect, it } from "vitest";
import { NO_RESULTS, restoreResults, results } from "../../../src/app/state/results";
import { showFace, showTab } from "../../../src/app/state/viewState";
import { cornerAt, graphOverlay } from "../../../src/app/view/images/graphOverlay";
import { rowsOf, shapesOf, siblingsOf, titleOf } from "../../../src/kinds/kinds";
import type { Related, Row } from "../../../src/kinds/parts/rows";
import { planesOfCorner } from "../../../src/kinds/planes/corner";
import {
  type AdjacencyGraphs,
  type CornerPlane,
  cornerPlanesOf,
  type Facet,
  type GroupingTrace,
  type ImageGraph,
  isMadeFrom,
  type SpaceCorner,
  type SpaceEdge,
} from "../../../src/shared/records";
import { cornerParts } from "../../../src/stages/adjacency/tour";
import { tabsOf } from "../../../src/stages/catalogue";
import { presentEntries } from "../../../src/stages/PageLegend";
import { about } from "../kinds/about";

showFace("method");

const edgeInImage = (far: [number, number], direction: [number, number], region: number) => ({
  segment: 0,
  far,
  direction,
  sigma: 0.01,
  neighbour: null,
  region,
});
/** A corner to the east and the south, y down, and one that no other view shows. */
const GRAPH: ImageGraph = {
  corners: [
    {
      at: [10, 10],
      covariance: [
        [0.1, 0],
        [0, 0.1],
      ],
      edges: [edgeInImage([50, 10], [1, 0], 0), edgeInImage([10, 30], [0, 1], 1)],
      nats: 3,
    },
    {
      at: [80, 80],
      covariance: [
        [0.1, 0],
        [0, 0.1],
      ],
      edges: [edgeInImage([95, 80], [1, 0], 2), edgeInImage([80, 95], [0, 1], 3)],
      nats: 2,
    },
  ],
  regions: [],
};
const edge = (direction: [number, number, number], neighbour: number | null, k: number): SpaceEdge => ({
  direction,
  covariance: [
    [1e-4, 0, 0],
    [0, 1e-4, 0],
    [0, 0, 1e-4],
  ],
  length_m: 4,
  neighbour,
  images: [
    [0, k],
    [1, 0],
    [2, 0],
  ],
  nats: 5,
});
const corner = (at: [number, number, number], edges: SpaceEdge[], image: number): SpaceCorner => ({
  at,
  covariance: [
    [4e-4, 0, 0],
    [0, 4e-4, 0],
    [0, 0, 2.5e-3],
  ],
  images: [
    [0, image],
    [1, 0],
    [2, 0],
  ],
  edges,
  place_nats: 9,
  color_nats: -1,
});
const plane = (regions: [number, number][], insideNats: number): CornerPlane => ({
  regions,
  plane: { normal: [0, 0, 1], d: -5 },
  covariance: [
    [4e-4, 0, 0],
    [0, 1e-4, 0],
    [0, 0, 1e-4],
  ],
  polygon: [
    [0, 0, 5],
    [4, 0, 5],
    [0, 4, 5],
  ],
  coplanar_nats: 3,
  prior_nats: -1.5,
  inside_nats: insideNats,
});
const ADJACENCY: AdjacencyGraphs = {
  planes: [
    plane([[0, 0]], 6),
    plane([[0, 1]], 1),
    plane(
      [
        [0, 0],
        [1, 0],
      ],
      8,
    ),
  ],
  trace: {
    graphs: [GRAPH],
    corners: [
      corner([0, 0, 5], [edge([1, 0, 0], 1, 0), edge([0, -1, 0], null, 1)], 0),
      corner([5, 0, 5], [], 7),
    ],
  },
};
const FACET = {
  plane: { normal: [0, 0, 1], d: -5 },
  half_planes: [],
  proposals: [{ corner_plane: 2 }],
  similarity: 0.8,
  real_ratio: 1,
  outer: [],
  holes: [],
} as unknown as Facet;

function show(): void {
  const grouping = { groups: [] } as unknown as GroupingTrace;
  restoreResults({
    main: { ...NO_RESULTS, adjacency: ADJACENCY, grouping, facets: [FACET] },
    regions: NO_RESULTS,
  });
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

describe("the graph over an image", () => {
  it("tells what was found in other views from what was not", () => {
    const overlay = graphOverlay(ADJACENCY, 0);
    expect(overlay?.corners.map(({ space }) => space)).toEqual([0, null]);
    expect(overlay?.edges.map(({ isMatched }) => isMatched)).toEqual([true, true, false, false]);
    expect(graphOverlay(ADJACENCY, 4)).toBeNull();
  });

  it("has a sector between each edge and the next, clockwise, in the colour of its region", () => {
    const sectors = graphOverlay(ADJACENCY, 0)?.sectors ?? [];
    expect(sectors.map(({ region }) => region)).toEqual([0, 1, 2, 3]);
    const middle = (k: number) => sectors[k]?.ring[4] as readonly [number, number];
    expect(middle(0)[0]).toBeGreaterThan(10);
    expect(middle(0)[1]).toBeGreaterThan(10);
    expect(middle(1)[0]).toBeLessThan(10);
    expect(middle(1)[1]).toBeLessThan(10);
    // Half as far as the shorter edge.
    expect(Math.hypot(middle(0)[0] - 10, middle(0)[1] - 10)).toBeCloseTo(10);
  });

  it("is picked by its corners, as far as they are in space", () => {
    const overlay = graphOverlay(ADJACENCY, 0);
    expect(overlay && cornerAt(overlay, [12, 11], 8)).toBe(0);
    expect(overlay && cornerAt(overlay, [30, 11], 8)).toBeNull();
    expect(overlay && cornerAt(overlay, [80, 80], 8)).toBeNull();
  });
});

describe("a corner in space", () => {
  it("is told with its nats, its neighbours and its planes", () => {
    show();
    expect(titleOf({ kind: "corner", index: 0 }, about(results.value))).toBe("Corner 1");
    const rows = rowsOf({ kind: "corner", index: 0 }, about(results.value));
    expect(valueIn(rows, "Seen in")).toBe("3 views");
    expect(barsIn(rows, "For and against it (nats)")).toEqual([9, 10, -1]);
    expect(planesOfCorner(0, { adjacency: ADJACENCY })).toEqual([0, 1, 2]);
    expect(barsIn(rows, "Views agree inside (nats)")).toEqual([6, 8]);
    const names = (label: string) => (valueIn(rows, label) as Related[]).map(({ name }) => name);
    expect(names("Joined by an edge")).toEqual(["2"]);
    expect(names("Facets")).toEqual(["1"]);
    expect(rowsOf({ kind: "corner", index: 9 }, about(results.value))).toEqual([]);
    expect(
      valueIn(rowsOf({ kind: "facet", index: 0 }, about(results.value)), "Proposed by corners"),
    ).toMatchObject([{ name: "1" }, { name: "2" }]);
    expect(siblingsOf({ kind: "corner", index: 0 }, "adjacency", about(results.value))).toHaveLength(2);
  });

  it("lights up with its verified planes and its edges, which lead to its neighbours", () => {
    show();
    const shapes = shapesOf({ kind: "corner", index: 0 }, results.value);
    expect(shapes.map(({ role }) => role)).toEqual(["area", "area", "line", "line"]);
    expect(shapes[2]?.points).toEqual([
      [0, 0, 5],
      [5, 0, 5],
    ]);
    expect(shapes[3]?.points[1]).toEqual([0, -4, 5]);
    expect(shapesOf({ kind: "corner", index: 9 }, results.value)).toEqual([]);
  });

  it("proposes planes", () => {
    expect(cornerPlanesOf(FACET)).toEqual([2]);
    expect(isMadeFrom(FACET, { members: [], proposals: [{ corner_plane: 2 }] })).toBe(true);
    expect(isMadeFrom(FACET, { members: [], proposals: [{ corner_plane: 1 }] })).toBe(false);
  });

  it("has a tab, a legend and a step of the tour", () => {
    show();
    showTab("adjacency");
    expect(presentEntries().map(([colour]) => colour)).toEqual(["matched", "unmatched", "set"]);
    expect(tabsOf("adjacency")).toContain("adjacency");
    expect(tabsOf("adjacency")).not.toContain("halfplanes");
    expect(cornerParts({ adjacency: ADJACENCY }, 0)).toEqual({ views: 3, edges: 2, planes: 2 });
    expect(cornerParts({ adjacency: ADJACENCY }, 1)?.planes).toBe(1);
    expect(cornerParts({ adjacency: ADJACENCY }, 5)).toBeNull();
  });
});

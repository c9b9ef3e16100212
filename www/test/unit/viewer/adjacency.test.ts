/** Corners and their planes in space: which planes are thin, and what a click on one picks. */
import type { Intersection } from "three";
import { describe, expect, it } from "vitest";
import { edgesOfCorner, isVerifiedPlane } from "../../../src/shared/proposed";
import type { AdjacencyGraphs } from "../../../src/shared/records";
import { buildAdjacency } from "../../../src/stages/adjacency/adjacencyLayer";

const plane = (corner: number, insideNats: number) => ({
  regions: [[corner, 0]],
  polygon: [
    [0, 0, 5],
    [4, 0, 5],
    [0, 4, 5],
  ],
  prior_nats: -1,
  inside_nats: insideNats,
});
const ADJACENCY = {
  planes: [plane(0, 5), plane(1, 0.5)],
  trace: {
    graphs: [],
    corners: [
      { at: [0, 0, 5], edges: [{ direction: [1, 0, 0], length_m: 4, neighbour: 1 }] },
      { at: [4, 0, 5], edges: [{ direction: [0, 1, 0], length_m: 2, neighbour: null }] },
    ],
  },
} as unknown as AdjacencyGraphs;

describe("the layer of corners", () => {
  const layer = buildAdjacency(ADJACENCY);
  layer.highlight(null);
  const [edges, polygon, refused] = layer.object.children;
  const pick = (object: unknown, faceIndex: number) => layer.pick({ object, faceIndex } as Intersection);

  it("has the photographs' verdict over the odds before", () => {
    expect(ADJACENCY.planes.map(isVerifiedPlane)).toEqual([true, false]);
    expect(isVerifiedPlane(undefined)).toBe(false);
  });

  it("leads edges to the corners that they join", () => {
    const { corners } = ADJACENCY.trace;
    expect(corners.flatMap((corner) => edgesOfCorner(corner, corners))).toEqual([
      [
        [0, 0, 5],
        [4, 0, 5],
      ],
      [
        [4, 0, 5],
        [4, 2, 5],
      ],
    ]);
  });

  it("picks a corner by its edges and by the planes that it proposed", () => {
    expect(pick(edges, 1)).toEqual({ kind: "corner", index: 1 });
    expect(pick(polygon, 2)).toEqual({ kind: "corner", index: 0 });
    expect(pick(refused, 0)).toEqual({ kind: "corner", index: 1 });
    expect(pick(null, 0)).toBeNull();
  });

  it("shows what is picked over all else", () => {
    layer.highlight({ kind: "corner", index: 0 });
    expect(layer.object.children).toHaveLength(4);
    layer.highlight({ kind: "line", index: 0 });
    expect(layer.object.children).toHaveLength(3);
    layer.dispose();
  });
});

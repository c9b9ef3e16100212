/** The overview of groups: what became a facet stands out, in the colour of its group. */
import type { Intersection } from "three";
import type { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { expect, it } from "vitest";
import type { Facet, GroupingTrace } from "../../../src/shared/records";
import { buildGroups } from "../../../src/stages/groups/groupsLayer";
import { isOfRoof, middleOf } from "../../../src/viewer/scene/facetPlan";

const PLANE = { normal: [0, 0, 1] as [number, number, number], d: -5 };
const SQUARE: Facet["outer"] = [
  [0, 0, 5],
  [4, 0, 5],
  [4, 4, 5],
  [0, 4, 5],
];
const FACET = {
  plane: PLANE,
  outer: SQUARE,
  holes: [],
  half_planes: [7],
  proposals: [],
} as unknown as Facet;
/** Group 0 lies on the ground and is the larger; group 1 became the facet; line 1 is of both. */
const GROUPING = {
  groups: [
    {
      plane: PLANE,
      members: [0, 1, 2].map((line) => ({ line, side: "left", half_plane: null })),
      proposals: [],
    },
    { plane: PLANE, members: [{ line: 1, side: "left", half_plane: 7 }], proposals: [] },
  ],
  plane_lines: [
    { segment: { p0: [0, 0, 5], p1: [4, 0, 5] }, views: [0] },
    { segment: { p0: [1, 1, 0], p1: [2, 1, 0] }, views: [0] },
    { segment: { p0: [30, 0, 5], p1: [34, 0, 5] }, views: [0] },
  ],
  borders: [],
  cells: 0,
  rejected: [],
} as unknown as GroupingTrace;

it("dims lines of groups without a facet, and picks the group of a line or of an area", () => {
  const lines = Float64Array.from([0, 1, 2].flatMap((i) => [0, i, 0, 1, i, 0]));
  const layer = buildGroups(GROUPING, lines, [FACET]);
  layer.highlight(null);
  const [roof, other, found, area] = layer.object.children as LineSegments2[];
  expect([roof, other, found].map((one) => one?.geometry.instanceCount)).toEqual([1, 2, 1]);
  expect(other?.material.opacity).toBeLessThan(roof?.material.opacity ?? 0);
  expect(other?.material.linewidth).toBeLessThan(roof?.material.linewidth ?? 0);
  const pick = (object: unknown) => layer.pick({ object, faceIndex: 0 } as Intersection);
  expect(pick(roof)).toEqual({ kind: "group", index: 1 });
  expect(pick(other)).toEqual({ kind: "group", index: 0 });
  expect(pick(area)).toEqual({ kind: "group", index: 1 });
});

it("knows lines at a facet from lines beside it, and where its name stands", () => {
  expect(isOfRoof({ a: [0, 4.2], b: [4, 4.2] }, [SQUARE])).toBe(true);
  expect(isOfRoof({ a: [1, 1], b: [2, 2] }, [SQUARE])).toBe(true);
  expect(isOfRoof({ a: [0, 6], b: [4, 6] }, [SQUARE])).toBe(false);
  expect(middleOf(SQUARE)).toEqual([2, 2, 5]);
});

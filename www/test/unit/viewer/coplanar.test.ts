/** Polygons of coplanar lines in space: which are thin, and what a click on one picks. */
import type { Intersection } from "three";
import { describe, expect, it } from "vitest";
import { isVerifiedSet } from "../../../src/shared/proposed";
import type { CoplanarSets } from "../../../src/shared/records";
import { buildCoplanar } from "../../../src/stages/coplanar/coplanarLayer";

const triangle = (x: number) => [
  [x, 0, 5],
  [x + 4, 0, 5],
  [x, 4, 5],
];
const set = (x: number, insideNats: number) => ({
  lines: [0],
  hull: triangle(x),
  polygon: triangle(x),
  inside_nats: insideNats,
  outline_nats: -10,
});
const COPLANAR = { sets: [set(0, 5), set(9, 30)], trace: { sets: [] } } as unknown as CoplanarSets;

describe("the layer of coplanar sets", () => {
  const layer = buildCoplanar(COPLANAR, Float64Array.from([0, 0, 5, 4, 0, 5]));
  layer.highlight(null);
  const [polygon, hull, refused] = layer.object.children;

  it("has the photographs' verdict", () => {
    expect(COPLANAR.sets.map(isVerifiedSet)).toEqual([false, true]);
  });

  it("picks a set by any side of its polygon, and nothing by a hull", () => {
    const pick = (object: unknown, faceIndex: number) => layer.pick({ object, faceIndex } as Intersection);
    expect([0, 1, 2].map((side) => pick(polygon, side))).toEqual(
      new Array(3).fill({ kind: "coplanar", index: 1 }),
    );
    expect(pick(refused, 0)).toEqual({ kind: "coplanar", index: 0 });
    expect(pick(hull, 0)).toBeNull();
  });

  it("shows what is picked over all else", () => {
    layer.highlight({ kind: "coplanar", index: 1 });
    expect(layer.object.children).toHaveLength(4);
    layer.highlight({ kind: "line", index: 0 });
    expect(layer.object.children).toHaveLength(3);
    layer.dispose();
  });
});

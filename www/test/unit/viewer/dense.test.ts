/** The patches of dense matching in space: where they lie, and what a click on one picks. */
import type { BufferGeometry, Intersection, Mesh, MeshBasicMaterial } from "three";
import { describe, expect, it } from "vitest";
import type { DensePlane, DensePlanes } from "../../../src/shared/records";
import { heightAt, likeliestClass, planesOfPatches } from "../../../src/shared/surfaceClass";
import { buildDense } from "../../../src/stages/dense/denseLayer";

type Squares = Mesh<BufferGeometry, MeshBasicMaterial>;

/** z = 5 + x / 2 over patches 0 and 2, whose own heights are a little off; patch 1 lies in no plane. */
const SLOPE = { normal: [-1, 0, 2].map((n) => n / Math.sqrt(5)), d: -10 / Math.sqrt(5) };
const DENSE = {
  planes: [
    { plane: SLOPE, patches: [0, 2], class: { building: 0.7, ground: 0.1, vegetation: 0.2 }, ring: [] },
  ],
  trace: {
    patches: [0, 1, 2].map((x) => ({ middle: [x, 0], z: 5.3 + x / 2, gradient: [0, 0], correlation: 0.9 })),
    classes: [],
    spacing_m: 1,
  },
} as unknown as DensePlanes;

const cornersOf = (mesh: Squares | undefined) => {
  const { array = [] } = mesh?.geometry.getAttribute("position") ?? {};
  return Array.from({ length: array.length / 3 }, (_, i) => [...array].slice(3 * i, 3 * i + 3));
};

describe("the layer of dense planes", () => {
  const layer = buildDense(DENSE);
  layer.highlight(null);
  const [inPlane, free] = layer.object.children as Squares[];

  it("lays the patches of a plane into it, and leaves others where matching put them", () => {
    expect(cornersOf(inPlane)).toHaveLength(8);
    for (const [x = 0, , z] of cornersOf(inPlane)) {
      expect(z).toBeCloseTo(5 + x / 2, 5);
    }
    expect(cornersOf(free).map(([, , z]) => z)).toEqual(new Array(4).fill(expect.closeTo(5.8, 5)));
    const width = (mesh: Squares | undefined) =>
      (cornersOf(mesh)[1]?.[0] ?? 0) - (cornersOf(mesh)[0]?.[0] ?? 0);
    expect(width(free)).toBeLessThan(width(inPlane) / 2);
  });

  it("is as opaque as the class is probable", () => {
    expect(inPlane?.geometry.getAttribute("color").getW(0)).toBeCloseTo(0.7, 6);
    expect(free?.geometry.getAttribute("color").getW(0)).toBe(1);
  });

  it("picks the plane of a patch by either triangle, and nothing by a patch in no plane", () => {
    const pick = (object: unknown, faceIndex: number) => layer.pick({ object, faceIndex } as Intersection);
    expect([0, 1, 2, 3].map((face) => pick(inPlane, face))).toEqual(
      new Array(4).fill({ kind: "dense", index: 0 }),
    );
    expect(pick(free, 0)).toBeNull();
  });

  it("dims all but what is picked", () => {
    const before = inPlane?.material.opacity ?? 0;
    layer.highlight({ kind: "dense", index: 0 });
    expect(inPlane?.material.opacity).toBeLessThan(before / 2);
    expect(layer.object.children).toHaveLength(3);
    layer.highlight({ kind: "line", index: 0 });
    expect(layer.object.children).toHaveLength(2);
    layer.highlight(null);
    expect(inPlane?.material.opacity).toBe(before);
  });
});

describe("surface classes", () => {
  it("are told by the most probable one, the first of equal ones", () => {
    const of = (building: number, ground: number, vegetation: number) =>
      likeliestClass({ building, ground, vegetation });
    expect(of(0.2, 0.3, 0.5)).toEqual({ name: "vegetation", probability: 0.5 });
    expect(of(0.4, 0.4, 0.2)).toEqual({ name: "building", probability: 0.4 });
  });

  it("know which patch is of which plane, and how high that is", () => {
    expect([...planesOfPatches(DENSE)]).toEqual([0, -1, 0]);
    expect(heightAt(DENSE.planes[0] as DensePlane, 4, 9)).toBeCloseTo(7, 9);
  });
});

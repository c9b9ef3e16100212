import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  Vector3,
} from "three";
import { describe, expect, it } from "vitest";
import { clippingPlane, sectionOf } from "../../../src/viewer/tools/section";

/** A roof whose ridge runs along x at height 8, eaves at height 5 and z = -4 and 4. */
function roof(): Mesh {
  const [a, b, c, d, e, f] = [
    [-6, 5, -4],
    [6, 5, -4],
    [6, 5, 4],
    [-6, 5, 4],
    [-6, 8, 0],
    [6, 8, 0],
  ] as const;
  const triangles = [a, b, f, a, f, e, e, f, c, e, c, d];
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(triangles.flat()), 3));
  return new Mesh(geometry, new MeshBasicMaterial({ side: DoubleSide }));
}

describe("sectionOf", () => {
  it("cuts a gable across into two slopes", () => {
    const { lengthM, pieces } = sectionOf([roof()], new Vector3(1, 0, -6), new Vector3(1, 0, 6));
    expect(lengthM).toBeCloseTo(12);
    expect(pieces.length).toBe(2);
    const [up, down] = pieces;
    expect(up?.from[0]).toBeCloseTo(2);
    expect(up?.from[1]).toBeCloseTo(5);
    expect(up?.to[0]).toBeCloseTo(6);
    expect(up?.to[1]).toBeCloseTo(8);
    expect(up?.slope).toBeCloseTo(Math.atan2(3, 4));
    expect(down?.slope).toBeCloseTo(-Math.atan2(3, 4));
    expect(down?.to[0]).toBeCloseTo(10);
  });

  it("ends where the points are, and sees a face that is shown twice once", () => {
    const { pieces } = sectionOf([roof(), roof()], new Vector3(0, 9, -2), new Vector3(0, 9, 0.5));
    expect(pieces.length).toBe(2);
    expect(pieces[0]?.from).toEqual([0, expect.closeTo(6.5)]);
    expect(pieces[1]?.to[0]).toBeCloseTo(2.5);
    expect(pieces[1]?.to[1]).toBeCloseTo(8 - 0.375);
  });

  it("follows the frame of its object, and finds walls", () => {
    const group = new Group();
    group.rotation.x = -Math.PI / 2;
    // 2 m by 4 m in plan and 6 m high, Z up.
    group.add(new Mesh(new BoxGeometry(2, 4, 6)));
    const { pieces } = sectionOf([group], new Vector3(-5, 0, 0.3), new Vector3(5, 0, 0.3));
    expect(pieces.length).toBe(4);
    expect(pieces.filter(({ slope }) => Math.abs(slope) > 1.5).length).toBe(2);
    const heights = pieces.flatMap(({ from, to }) => [from[1], to[1]]);
    expect(Math.max(...heights)).toBeCloseTo(3);
    expect(Math.min(...heights)).toBeCloseTo(-3);
  });

  it("finds nothing where there is nothing, or no direction", () => {
    expect(sectionOf([roof()], new Vector3(20, 0, 0), new Vector3(21, 0, 1)).pieces).toEqual([]);
    expect(sectionOf([roof()], new Vector3(), new Vector3()).pieces).toEqual([]);
  });
});

describe("clippingPlane", () => {
  it("takes away the side of the eye", () => {
    const plane = clippingPlane(new Vector3(0, 0, 0), new Vector3(1, 0, 0), new Vector3(3, 10, 20));
    expect(plane.distanceToPoint(new Vector3(0, 0, 5))).toBeLessThan(0);
    expect(plane.distanceToPoint(new Vector3(0, 0, -5))).toBeGreaterThan(0);
    expect(plane.distanceToPoint(new Vector3(0.5, 7, 0))).toBeGreaterThan(0);
  });
});

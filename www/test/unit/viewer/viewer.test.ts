import { PerspectiveCamera, Sphere, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { HalfPlane } from "../../../src/shared/records";
import { fanCorners } from "../../../src/stages/halfplanes/fansLayer";
import { groundCorners } from "../../../src/viewer/layers/cameras";
import { normalTint } from "../../../src/viewer/layers/facets";
import { endsOfLines, isNearlySame, standFor } from "../../../src/viewer/scene/bounds";
import { yUp, zUpGroup } from "../../../src/viewer/scene/frame";

describe("frame", () => {
  it("turns Z up into Y up as the GLB does", () => {
    expect(yUp([1, 2, 3]).toArray()).toEqual([1, 3, -2]);
  });

  it("turns the children of its group by the same map", () => {
    const group = zUpGroup();
    const turned = new Vector3(1, 2, 3).applyMatrix4(group.matrix);
    expect(turned.distanceTo(yUp([1, 2, 3]))).toBeLessThan(1e-12);
  });
});

describe("fanCorners", () => {
  const line = Float64Array.from([0, 0, 5, 10, 0, 5]);
  const halfPlane = (side: "left" | "right", normal: [number, number, number]): HalfPlane => ({
    line: 0,
    side,
    theta: 0,
    sigma_theta: 0.01,
    similarity: 1,
    curvature: 9,
    amplitude: 1,
    probability: 1,
    views: [],
    plane: { normal, d: -5 },
  });

  it.each([
    ["left", 1],
    ["right", -1],
  ] as const)("lies to the %s of the line, seen from above", (side, sign) => {
    const corners = fanCorners(halfPlane(side, [0, 0, 1]), line);
    expect(corners.slice(2).every(({ y }) => Math.sign(y) === sign)).toBe(true);
  });

  it("lies in its plane", () => {
    const normal = new Vector3(0, -0.6, 0.8);
    const corners = fanCorners(halfPlane("left", [0, -0.6, 0.8]), line);
    for (const corner of corners) {
      expect(normal.dot(corner)).toBeCloseTo(4, 9);
    }
    expect(corners[2]?.z).toBeGreaterThan(5);
  });
});

describe("groundCorners", () => {
  it("finds the ground below the image corners of a camera that looks down", () => {
    // Focal length 100 px, 200 x 100 px, 50 m above the ground, x east, y south.
    const projection = [100, 0, -100, 5000, 0, -100, -50, 2500, 0, 0, -1, 50];
    const centre = new Vector3(0, 0, 50);
    const view = {
      name: "a",
      width: 200,
      height: 100,
      center: [0, 0, 50] as [number, number, number],
      projection,
    };
    const corners = groundCorners(view, centre, 0);
    expect(corners?.map(({ x, y, z }) => [x, y, z].map((v) => Math.round(v * 1e6) / 1e6 + 0))).toEqual([
      [-50, 25, 0],
      [50, 25, 0],
      [50, -25, 0],
      [-50, -25, 0],
    ]);
  });

  it("has no answer for rays that never reach that height", () => {
    const projection = [100, 0, -100, 5000, 0, -100, -50, 2500, 0, 0, -1, 50];
    const view = {
      name: "a",
      width: 200,
      height: 100,
      center: [0, 0, 50] as [number, number, number],
      projection,
    };
    expect(groundCorners(view, new Vector3(0, 0, 50), 80)).toBeNull();
  });
});

describe("normalTint", () => {
  const tint = (normal: [number, number, number]) => normalTint({ plane: { normal, d: 0 } });

  it("gives opposite slopes different hues, and a level facet none", () => {
    const south = tint([0, -0.6, 0.8]).getHSL({ h: 0, s: 0, l: 0 });
    const north = tint([0, 0.6, 0.8]).getHSL({ h: 0, s: 0, l: 0 });
    expect(Math.abs(south.h - north.h)).toBeGreaterThan(0.2);
    expect(tint([0, 0, 1]).getHSL({ h: 0, s: 0, l: 0 }).s).toBeLessThan(0.02);
  });
});

describe("isNearlySame", () => {
  const sphere = (x: number, radius: number) => new Sphere(new Vector3(x, 0, 0), radius);

  it("holds for a model where a preliminary one was, and for no other place or size", () => {
    const seen = sphere(0, 20);
    const pairs = [sphere(0, 20), sphere(3, 20), sphere(0, 23), sphere(-5, 15)];
    expect(pairs.map((next) => isNearlySame(seen, next))).toEqual([true, true, true, true]);
    const others = [sphere(6, 20), sphere(0, 25), sphere(0, 12), sphere(100, 20)];
    expect(others.map((next) => isNearlySame(seen, next))).toEqual([false, false, false, false]);
  });
});

describe("endsOfLines", () => {
  it("is not blown up by one stray line", () => {
    const lines = Array.from({ length: 60 }, (_, i) => [
      i % 10,
      Math.floor(i / 10),
      5,
      (i % 10) + 1,
      i / 10,
      5,
    ]);
    lines.push([9000, 9000, 5, 9001, 9000, 5]);
    const ends = endsOfLines(Float64Array.from(lines.flat()));
    expect(Math.max(...ends.map((end) => end.length()))).toBeLessThan(20);
    expect(ends.length).toBeGreaterThan(90);
  });
});

describe("standFor", () => {
  it.each([
    [40, 4, 30, 2.3],
    [6, 30, 6, 0.6],
  ])("has points within %d x %d x %d m just in the picture, at aspect %f", (x, y, z, aspect) => {
    const share = (i: number, step: number) => ((i * step) % 1) - 0.5;
    const points = Array.from(
      { length: 60 },
      (_, i) => new Vector3(100 + x * share(i, 0.618), y * share(i, 0.414), z * share(i, 0.732) - 50),
    );
    const camera = new PerspectiveCamera(35, aspect, 0.1, 1000);
    const towards = new Vector3(-0.45, 0.72, 0.62).normalize();
    const upright = Math.tan((35 * Math.PI) / 360);
    const { position, target } = standFor(points, towards, [aspect * upright, upright]);
    camera.position.copy(position);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    const seen = points.map((point) => point.clone().project(camera));
    // From edge to edge in one direction, and within the picture in the other one.
    const extents = (["x", "y"] as const).map((axis) => seen.map((point) => point[axis]));
    const filled = extents.map((places) => Math.min(Math.max(...places), -Math.min(...places)));
    expect(Math.max(...filled)).toBeCloseTo(1, 6);
    expect(Math.max(...extents.flat().map(Math.abs))).toBeCloseTo(1, 6);
  });
});

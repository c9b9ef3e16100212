import { type Intersection, type LineSegments, Vector3, Vector4 } from "three";
import { describe, expect, it } from "vitest";
import { project } from "../../../src/kinds/parts/marks";
import type { Vec3, ViewInfo } from "../../../src/shared/records";
import { buildFans, buildTurning, fanCorners } from "../../../src/stages/halfplanes/fansLayer";
import { yUp } from "../../../src/viewer/scene/frame";
import { clipFromViewer, fitShares } from "../../../src/viewer/scene/photoProjection";
import { measure } from "../../../src/viewer/tools/measure";

/** Looks down from 1000 m, principal point far outside the image. */
const VIEW: ViewInfo = {
  name: "a.jpg",
  width: 600,
  height: 400,
  center: [0, 0, 1000],
  projection: [12000, 0, 2000, -2000 * 1000, 0, -12000, -1500, 1500 * 1000, 0, 0, -1, 1000],
};
const POINTS: Vec3[] = [
  [180, -140, 5],
  [200, -120, 12],
  [190, -130, 0],
];

describe("clipFromViewer", () => {
  it.each([0.7, 1.5, 3])("puts points where the photograph shows them, at aspect %f", (aspect) => {
    const clip = clipFromViewer(VIEW, aspect, 100, 3000);
    const [sx, sy] = fitShares(VIEW, aspect);
    for (const point of POINTS) {
      const [x, y] = project(VIEW, point) as [number, number];
      const { x: u, y: v, z: depth, w } = new Vector4(...yUp(point).toArray(), 1).applyMatrix4(clip);
      expect(u / w).toBeCloseTo(sx * ((2 * x) / VIEW.width - 1), 9);
      expect(v / w).toBeCloseTo(sy * (1 - (2 * y) / VIEW.height), 9);
      expect(Math.abs(depth / w)).toBeLessThan(1);
      expect(w).toBeCloseTo(1000 - point[2], 9);
    }
  });
});

describe("project", () => {
  it("sees nothing behind the camera", () => {
    expect(project(VIEW, [0, 0, 1001])).toBeNull();
  });
});

describe("measure", () => {
  const at = (point: Vec3) => yUp(point);

  it("gives distance, height and slope of the last step", () => {
    const { distanceM, planM, heightM, slope, areaM2 } = measure([at([0, 0, 0]), at([3, 0, 4])]);
    expect(distanceM).toBeCloseTo(5);
    expect([planM, heightM]).toEqual([3, 4]);
    expect(slope).toBeCloseTo(Math.atan2(4, 3));
    expect(areaM2).toBeNull();
  });

  it("gives the sloped area of a polygon", () => {
    // 4 m by 3 m in plan, rising 4 m over the 3 m: 4 m by 5 m.
    const square = [at([0, 0, 0]), at([4, 0, 0]), at([4, 3, 4]), at([0, 3, 4])];
    expect(measure(square).areaM2).toBeCloseTo(20);
  });

  it("says nothing of a single point", () => {
    expect(measure([new Vector3()])).toMatchObject({ points: 1, distanceM: null, slope: null });
  });
});

describe("buildFans", () => {
  it("draws the sides that were swept and rejected, not those on the ground", () => {
    const lines = Float64Array.from([0, 0, 0, 9, 0, 0, 0, 0, 5, 9, 0, 5]);
    const layer = buildFans([], lines, [
      { line: 0, side: "left", rejection: "on_ground" },
      { line: 1, side: "left", rejection: null },
      { line: 1, side: "right", rejection: "flat_curve" },
    ]);
    const drawn = layer.object.children.at(-1) as LineSegments;
    expect(drawn.geometry.getAttribute("position").count).toBe(2);
    const hit = { object: drawn, index: 0 } as unknown as Intersection;
    expect(layer.pick(hit)).toEqual({ kind: "side", line: 1, side: "right" });
  });
});

describe("buildTurning", () => {
  const ends: [Vec3, Vec3] = [
    [0, 0, 5],
    [10, 0, 5],
  ];

  it.each([
    ["left", 0.5],
    ["right", -0.4],
  ] as const)("lies in the half-plane at theta: %s, %f", (side, theta) => {
    const fan = buildTurning(ends, side, theta);
    const [position] = fan.object.children.map(
      (child) =>
        (
          child as unknown as { geometry: { getAttribute(name: string): { array: Float32Array } } }
        ).geometry.getAttribute("position").array,
    );
    const away = new Vector3().fromArray(position as Float32Array, 9).sub(new Vector3(...ends[0]));
    expect(Math.atan2(away.z, Math.abs(away.y))).toBeCloseTo(theta, 5);
    expect(away.y > 0).toBe(side === "left");
    // The same fan as that of the accepted half-plane with this theta.
    const sign = side === "left" ? 1 : -1;
    const accepted = fanCorners(
      {
        line: 0,
        side,
        theta,
        sigma_theta: 0.01,
        similarity: 1,
        curvature: 9,
        amplitude: 1,
        probability: 1,
        views: [],
        plane: { normal: [0, -sign * Math.sin(theta), Math.cos(theta)], d: 0 },
      },
      Float64Array.from(ends.flat()),
    );
    expect(
      (accepted[3] as Vector3)
        .clone()
        .sub(new Vector3(...ends[0]))
        .distanceTo(away),
    ).toBeLessThan(1e-5);
  });
});

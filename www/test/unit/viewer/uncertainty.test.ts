import { Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { LineRecord } from "../../../src/shared/records";
import {
  buildUncertainty,
  type Covariance,
  ellipse,
  enlargement,
} from "../../../src/stages/lines/uncertaintyLayer";

const U = new Vector3(1, 0, 0);
const V = new Vector3(0, 0, 1);

describe("ellipse", () => {
  it("has the standard deviations as semi-axes", () => {
    const corners = ellipse([0.04, 0, 0, 0, 0, 0.01], U, V);
    expect(Math.max(...corners.map(({ x }) => x))).toBeCloseTo(0.2);
    expect(Math.max(...corners.map(({ z }) => z))).toBeCloseTo(0.1);
  });

  it("satisfies x' M^-1 x = 1 where the axes are turned", () => {
    const [a, b, c] = [0.05, 0.02, 0.01];
    const covariance: Covariance = [a, 0, b, 0, 0, c];
    for (const { x, z } of ellipse(covariance, U, V)) {
      expect((c * x * x - 2 * b * x * z + a * z * z) / (a * c - b * b)).toBeCloseTo(1, 9);
    }
  });

  it("is a point where nothing is uncertain", () => {
    for (const corner of ellipse([0, 0, 0, 0, 0, 0], U, V)) {
      expect(corner.length()).toBe(0);
    }
  });
});

const record = (sigma: number): LineRecord => {
  const covariance: Covariance = [sigma ** 2, 0, 0, sigma ** 2, 0, sigma ** 2];
  return {
    origin: "matched",
    contradiction: null,
    probability: 1,
    by_views: null,
    in_model: null,
    sigma_m: sigma,
    covariance: [covariance, covariance],
    supports: [],
  };
};

it("enlarges by a round factor", () => {
  expect(enlargement([record(0.012)])).toBe(50);
  expect(enlargement([record(0.6)])).toBe(1);
  expect(enlargement([record(0.001), record(0.02), record(1)])).toBe(50);
  expect(enlargement([])).toBe(100);
});

it("surrounds the line at the enlarged distance, and knows which line it is", () => {
  const lines = Float64Array.from([0, 0, 0, 10, 0, 0, 0, 5, 0, 0, 5, 8]);
  const layer = buildUncertainty(lines, [record(0.02), record(0.03)], 10, () => []);
  const mesh = layer.object.children[0] as import("three").Mesh;
  const positions = mesh.geometry.getAttribute("position");
  expect(positions.count).toBe(2 * 2 * 16);
  for (let i = 0; i < 16; i += 1) {
    expect(positions.getX(i)).toBeCloseTo(0);
    expect(Math.hypot(positions.getY(i), positions.getZ(i))).toBeCloseTo(0.2);
    expect(positions.getZ(i + 48)).toBeCloseTo(8);
  }
  expect(
    layer.pick({ object: layer.object.children[0], faceIndex: 33 } as import("three").Intersection),
  ).toEqual({ kind: "line", index: 1 });
});

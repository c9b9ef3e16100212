import { describe, expect, it } from "vitest";
import { quantile } from "../../../src/app/figures/LineLabs";
import { axesOf, frameOf, histogramOf, ticks } from "../../../src/app/parts/charts";

describe("ticks", () => {
  it("are round and inside", () => {
    expect(ticks({ min: 0, max: 1 }, 4)).toEqual([0, 0.5, 1]);
    expect(ticks({ min: 71.3, max: 84.1 }, 4)).toEqual([75, 80]);
    expect(ticks({ min: 1, max: 1 })).toEqual([]);
  });
});

describe("axes", () => {
  it("run to the right and upwards", () => {
    const frame = frameOf(400, 200);
    const scale = { min: 0, max: 10 };
    const [toX, toY] = axesOf(frame, scale, scale);
    expect(toX(0)).toBe(frame.left);
    expect(toX(10)).toBe(frame.width - frame.right);
    expect(toY(0)).toBe(frame.height - frame.bottom);
    expect(toY(10)).toBe(frame.top);
  });
});

describe("histogramOf", () => {
  it("counts each value once, the largest in the last bin", () => {
    expect(histogramOf([0, 0.9, 1, 4], { min: 0, max: 4 }, 4)).toEqual([2, 1, 0, 1]);
  });
});

describe("quantile", () => {
  it("sorts by number", () => {
    expect(quantile([10, 9, 100], 0.5)).toBe(10);
    expect(quantile([], 0.5)).toBe(0);
  });
});

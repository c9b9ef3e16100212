import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { axesOf, closedPathOf, frameOf, histogramOf, pathOf, ticks } from "../../../src/app/parts/charts";
import { oneScale } from "../../../src/app/view/space/SectionChart";
import { planeNames } from "../../../src/stages/clusters/ClusterLab";
import { quantile } from "../../../src/stages/lines/LineLab";

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

describe("paths", () => {
  it("are valid whatever they are given", () => {
    const nowhere = [Number.NEGATIVE_INFINITY, Number.NaN] as const;
    expect(pathOf([nowhere, [1, 2], [3, 4]])).toBe("M1.0 2.0L3.0 4.0");
    expect(closedPathOf([[1, 2], nowhere, [3, 4]])).toBe("M1.0 2.0L3.0 4.0Z");
    expect(closedPathOf([])).toBe("");
    expect(closedPathOf([nowhere])).toBe("");
  });
});

describe("the section's scale", () => {
  it("is the same both ways, whatever the frame", () => {
    for (const frame of [frameOf(460, 200), frameOf(200, 400)]) {
      const [x, y] = oneScale(frame, { min: 0, max: 30 }, { min: 80, max: 90 });
      const [toX, toY] = axesOf(frame, x, y);
      expect(toX(11) - toX(10)).toBeCloseTo(toY(80) - toY(81), 6);
      expect([x.min <= 0, x.max >= 30, y.min <= 80, y.max >= 90]).toEqual([true, true, true, true]);
    }
  });
});

describe("cluster planes", () => {
  it("are named by building and direction", () => {
    const right = Math.PI / 2;
    const planes = [0.5, 0.5 + right, 1, 1 + right].map((azimuth) => ({ azimuth }));
    const windows = [0.5, 1].map((azimuth) => ({ directions: [{ azimuth, share: 1 }] }));
    expect(planeNames(planes, { windows } as never)).toEqual([
      "Building 1, along 29°",
      "Building 1, along 119°",
      "Building 2, along 57°",
      "Building 2, along 147°",
    ]);
    expect(planeNames(planes.slice(0, 1), null)).toEqual(["Lines along 29°"]);
  });
});

describe("chart text", () => {
  it("is at least 12 px large", () => {
    const app = new URL("../../../src/app/", import.meta.url);
    const sheets = readdirSync(app, { recursive: true, encoding: "utf8" }).filter((name) =>
      name.endsWith(".css"),
    );
    const sizes = sheets.flatMap((name) =>
      [...readFileSync(new URL(name, app), "utf8").matchAll(/\.chart[^{]*\{[^}]*font-size: ([^;]+);/g)].map(
        ([, size = ""]) => size,
      ),
    );
    expect(sizes.length).toBeGreaterThan(0);
    expect(sizes.filter((size) => !(Number.parseFloat(size) >= 12 && size.endsWith("px")))).toEqual([]);
  });
});

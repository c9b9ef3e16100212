/** Descriptions, evidence, roofs and main directions of the drawn figures: planted and recovered. */
import { describe, expect, it } from "vitest";
import { describe as bitsOf, byCount, shortest } from "../../../src/lessons/toy/description";
import {
  azimuthHistogram,
  azimuthOf,
  crossSum,
  mainDirection,
  seenLines,
} from "../../../src/lessons/toy/directions";
import {
  density,
  edgeNats,
  logGamma,
  natsOf,
  normal,
  OFF_PLANE,
  ON_PLANE,
  probabilityOf,
  reliability,
  stream,
} from "../../../src/lessons/toy/evidence";
import { aerial } from "../../../src/lessons/toy/house";
import { facetOf, heightOf, PLAN, ridgeOf, SIDES } from "../../../src/lessons/toy/roofs";
import { planArea } from "../../../src/shared/linear";

const DEGREE = Math.PI / 180;

describe("a row of grey values", () => {
  const planted = [12, 30, 47];
  const random = stream(9);
  const row = Array.from({ length: 60 }, (_, i) => {
    const level = [80, 150, 110, 190][planted.filter((at) => at <= i).length] ?? 0;
    return level + 8 * normal(random);
  });

  it("is described shortest by its own breaks", () => {
    const found = shortest(row, 8);
    expect(found).toHaveLength(3);
    found.forEach((at, i) => {
      expect(Math.abs(at - (planted[i] ?? 0))).toBeLessThanOrEqual(1);
    });
  });

  it("costs more for every break, and deviates less", () => {
    const [few, many] = [bitsOf(row, planted, 8), bitsOf(row, [...planted, 52], 8)];
    expect(many.model).toBeGreaterThan(few.model);
    expect(many.data).toBeLessThanOrEqual(few.data);
    expect(few.total).toBeCloseTo(few.model + few.data, 9);
    // A place among 60 pixels, and a grey value of 8 bits.
    expect(many.model - few.model).toBeCloseTo(Math.log2(60) + 8, 9);
    // A pixel that deviates by one standard deviation costs half a nat.
    const data = (row: readonly number[]) => bitsOf(row, [], 1).data;
    expect(data([99, 101]) - data([100, 100])).toBeCloseTo(1 / Math.LN2, 9);
  });

  it("deviates less with every break, and is shortest with the planted ones", () => {
    const all = byCount(row, 8);
    const bits = [0, 1, 2, 3, 4, 5, 6].map((k) => bitsOf(row, all.get(k) ?? [], 8));
    expect(bits.every(({ data }, k) => k === 0 || data <= (bits[k - 1]?.data ?? 0))).toBe(true);
    expect(Math.min(...bits.map(({ total }) => total))).toBe(bits[3]?.total);
  });

  it("without structure has no break", () => {
    const noise = Array.from({ length: 40 }, () => 100 + 8 * normal(random));
    expect(shortest(noise, 8)).toEqual([]);
  });
});

describe("evidence", () => {
  it("is of densities that have the area 1", () => {
    expect(logGamma(5)).toBeCloseTo(Math.log(24), 9);
    for (const of of [ON_PLANE, OFF_PLANE]) {
      let sum = 0;
      for (let c = -0.9995; c < 1; c += 0.001) sum += 0.001 * density(of, c);
      expect(sum).toBeCloseTo(1, 2);
    }
  });

  it("grows with the correlation, and a hidden view bounds what speaks against", () => {
    const cs = [-0.8, -0.4, 0, 0.4, 0.8].map((c) => natsOf(c));
    expect([...cs].sort((a, b) => a - b)).toEqual(cs);
    expect(natsOf(0.9)).toBeGreaterThan(0);
    expect(natsOf(0)).toBeLessThan(0);
    expect(natsOf(-0.9, 0.05)).toBeGreaterThanOrEqual(Math.log(0.05));
    expect(natsOf(0.8, 0.05)).toBeGreaterThan(natsOf(0.8) - 0.06);
    expect(natsOf(0.3, 1)).toBeCloseTo(0, 12);
  });

  it("is a probability by way of the odds before", () => {
    expect(probabilityOf(0)).toBe(0.5);
    expect(probabilityOf(0, 0.1)).toBeCloseTo(0.1, 12);
    expect(probabilityOf(Math.log(9), 0.1)).toBeCloseTo(0.5, 12);
  });

  it("of an edge is the logarithm of two Gaussians' ratio", () => {
    const bell = (x: number) => Math.exp(-(x ** 2) / 2);
    expect(edgeNats(1.3, 2.5)).toBeCloseTo(Math.log(bell(1.3 - 2.5) / bell(1.3)), 12);
  });

  it("is calibrated when counted once, and too sure when counted four times", () => {
    const random = stream(4);
    const all = Array.from({ length: 8000 }, () => {
      const isTrue = random() < 0.5;
      return { isTrue, nats: (isTrue ? 0.9 : -0.9) + Math.sqrt(1.8) * normal(random) };
    });
    for (const [stated, share] of reliability(all, 1, 10)) {
      expect(Math.abs(stated - share)).toBeLessThan(0.06);
    }
    const [stated = 0, share = 1] = reliability(all, 4, 10).at(-1) ?? [];
    expect(share).toBeLessThan(stated - 0.08);
  });
});

describe("roofs over a rectangle", () => {
  const slopes = { south: 35 * DEGREE, east: 30 * DEGREE, north: 35 * DEGREE, west: 50 * DEGREE };

  it("divide the plan among the lowest half-planes", () => {
    const rings = SIDES.map((side) => facetOf(slopes, side));
    const total = rings.reduce((sum, ring) => sum + planArea(ring), 0);
    expect(total).toBeCloseTo(4 * PLAN.length * PLAN.width, 9);
    for (const [i, side] of SIDES.entries()) {
      const ring = rings[i] ?? [];
      const middle = [0, 1].map(
        (k) => ring.reduce((sum, at) => sum + (at[k as 0 | 1] ?? 0), 0) / ring.length,
      );
      const height = (of: (typeof SIDES)[number]) => heightOf(of, slopes[of], middle[0] ?? 0, middle[1] ?? 0);
      expect(SIDES.filter((other) => height(other) < height(side))).toEqual([]);
    }
  });

  it("are gables where a side carries nothing", () => {
    const gable = { ...slopes, east: null, west: null };
    expect(facetOf(gable, "east")).toEqual([]);
    expect(planArea(facetOf(gable, "south"))).toBeCloseTo(2 * PLAN.length * PLAN.width, 9);
  });

  it("have the ridge where both half-planes are equally high", () => {
    const { inwards, z } = ridgeOf(30 * DEGREE, 45 * DEGREE);
    expect(heightOf("south", 30 * DEGREE, 0, inwards - PLAN.width)).toBeCloseTo(z, 12);
    expect(heightOf("north", 45 * DEGREE, 0, inwards - PLAN.width)).toBeCloseTo(z, 12);
  });
});

describe("main directions", () => {
  const cameras = [
    [-9, -8],
    [9, -8],
    [-9, 8],
    [9, 8],
  ].map(([x = 0, y = 0]) => aerial([x, y, 42]));

  it("are the azimuths of level lines", () => {
    for (const line of seenLines(cameras, 24 * DEGREE, 0, 0)) {
      const azimuth = azimuthOf(cameras[line.view] as (typeof cameras)[number], line.ends) / DEGREE;
      expect(Math.min(Math.abs(azimuth - 24), Math.abs(azimuth - 114))).toBeLessThan(1e-6);
    }
  });

  it("are found together among lines that are no edges", () => {
    const histogram = azimuthHistogram(cameras, seenLines(cameras, 24 * DEGREE, 12, 0.5), 90);
    expect(Math.abs(mainDirection(histogram) / DEGREE - 24)).toBeLessThan(2.1);
    expect(crossSum(histogram, mainDirection(histogram))).toBeGreaterThan(crossSum(histogram, 60 * DEGREE));
  });
});

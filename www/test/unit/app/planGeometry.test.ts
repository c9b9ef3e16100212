import { describe, expect, it } from "vitest";
import { minutesText } from "../../../src/app/parts/numberText";
import {
  boxOf,
  coverOf,
  frameOf,
  regionBetween,
  spacingOf,
} from "../../../src/app/project/flight/planGeometry";

describe("the plan of a flight", () => {
  const frame = frameOf([100, -50, 300, 50]);

  it("has north up, and one scale", () => {
    expect([frame.width, frame.height]).toEqual([1000, 500]);
    expect(frame.toDrawing([100, 50])).toEqual([0, 0]);
    expect(frame.toDrawing([300, -50])).toEqual([1000, 500]);
    expect(boxOf(frame, [150, -25, 250, 0])).toEqual({ x: 250, y: 250, width: 500, height: 125 });
  });

  it("gives back the place that was drawn", () => {
    const place: [number, number] = [137, 12];
    const [x, y] = frame.toDrawing(place);
    const [east, north] = frame.toWorld(x / frame.width, y / frame.height);
    expect(east).toBeCloseTo(place[0], 9);
    expect(north).toBeCloseTo(place[1], 9);
  });

  it("takes a region in whichever direction it is dragged", () => {
    const corners = [
      [110.2, 3.6],
      [120.7, -9.4],
    ] as const;
    for (const [a, b] of [corners, [corners[1], corners[0]]] as const) {
      expect(regionBetween([...a], [...b])).toEqual([110, -9, 121, 4]);
    }
  });

  it("shades by whether three photographs show a place", () => {
    expect([0, 2, 3, 11, 12, 90].map((count) => coverOf(count)?.from)).toEqual([undefined, 1, 3, 6, 12, 12]);
  });

  it("knows how far photographs lie apart", () => {
    const row = [0, 10, 20, 90].map((x): [number, number] => [x, 0]);
    expect(spacingOf(row, 1000)).toBe(10);
    expect(spacingOf([[1, 1]], 1000)).toBe(1000);
  });
});

describe("the time that is left", () => {
  it("is said in minutes, and no finer than it is known", () => {
    expect([20, 65, 420, 5400, 9100].map(minutesText)).toEqual([
      "less than a minute",
      "about a minute",
      "about 7 minutes",
      "about 1.5 hours",
      "about 2.5 hours",
    ]);
  });
});

import { describe, expect, it } from "vitest";
import { fitImage, nearestSegment, pan, pinch, toImage, zoomAt } from "../../../src/app/view/images/viewport";

describe("viewport", () => {
  it("shows the whole image in the middle", () => {
    const viewport = fitImage({ width: 600, height: 300 }, { width: 316, height: 316 });
    expect(viewport).toEqual({ scale: 0.5, x: 8, y: 83 });
  });

  it("keeps the point under the pointer when it zooms", () => {
    const before = { scale: 1.5, x: -20, y: 35 };
    const at = { x: 140, y: 90 };
    const after = zoomAt(before, at, 2.2, 0.1);
    expect(after.scale).toBeCloseTo(3.3);
    expect(toImage(after, at).x).toBeCloseTo(toImage(before, at).x);
    expect(toImage(after, at).y).toBeCloseTo(toImage(before, at).y);
  });

  it("stops zooming out at the least scale, without moving", () => {
    const before = { scale: 0.5, x: 10, y: 20 };
    expect(zoomAt(before, { x: 99, y: 99 }, 0.1, 0.5)).toEqual(before);
  });

  it("moves with the pointer", () => {
    const at = { x: 50, y: 60 };
    const before = { scale: 2, x: 5, y: 5 };
    const grabbed = toImage(before, at);
    expect(toImage(pan(before, 30, -10), { x: 80, y: 50 })).toEqual(grabbed);
  });
});

describe("nearestSegment", () => {
  const segments = Float32Array.from([0, 0, 10, 0, 0, 5, 10, 5]);

  it("finds the segment beside the pointer", () => {
    expect(nearestSegment(segments, 4, { x: 4, y: 4 }, 3)).toBe(1);
    expect(nearestSegment(segments, 4, { x: 4, y: 1 }, 3)).toBe(0);
  });

  it("measures to the end points, not to the endless line", () => {
    expect(nearestSegment(segments, 4, { x: 14, y: 0 }, 3)).toBe(-1);
    expect(nearestSegment(segments, 4, { x: 12, y: 0 }, 3)).toBe(0);
  });

  it("steps over what follows the end points", () => {
    const supports = Float32Array.from([0, 0, 10, 0, 2, 7, 0, 5, 10, 5, 0, 8]);
    expect(nearestSegment(supports, 6, { x: 5, y: 6 }, 3)).toBe(1);
  });

  it("copes with a segment of no length", () => {
    expect(nearestSegment(Float32Array.from([3, 3, 3, 3]), 4, { x: 3, y: 4 }, 2)).toBe(0);
  });
});

it("two fingers zoom and move: what is below them stays below them", () => {
  const viewport = { scale: 2, x: 10, y: -4 };
  const before = [
    { x: 100, y: 100 },
    { x: 200, y: 100 },
  ] as const;
  const after = [
    { x: 80, y: 150 },
    { x: 280, y: 150 },
  ] as const;
  const moved = pinch(viewport, before, after, 0.1);
  expect(moved.scale).toBe(4);
  before.forEach((at, i) => {
    const [was, is] = [toImage(viewport, at), toImage(moved, after[i] as (typeof after)[0])];
    expect(is.x).toBeCloseTo(was.x, 9);
    expect(is.y).toBeCloseTo(was.y, 9);
  });
});

import type { Intersection } from "three";
import type { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { expect, it } from "vitest";
import { PALETTE } from "../../../src/shared/palette";
import type { LineOrigin, LineRecord } from "../../../src/shared/records";
import { buildLines, colourOf, ORIGIN_COLOURS } from "../../../src/viewer/layers/lines";
import { sidesOf } from "../../../src/viewer/scene/strokes";

const record = (origin: LineOrigin, views: number): LineRecord => ({
  origin,
  contradiction: null,
  sigma_m: 0.1,
  covariance: [
    [1, 0, 0, 1, 0, 1],
    [1, 0, 0, 1, 0, 1],
  ],
  supports: Array.from({ length: views }, (_, view) => ({ view, segments: [], score: 1, kind: "grown" })),
});

it("draws lines that no view shows apart, dashed, and knows them when they are picked", () => {
  const records = [
    record("matched", 4),
    record("intersection", 0),
    record("border", 3),
    record("intersection", 3),
  ];
  const lines = Float64Array.from(records.flatMap((_, i) => [0, i, 0, 1, i, 0]));
  const layer = buildLines(lines, records, () => []);
  const [seen, unseen] = layer.object.children as [LineSegments2, LineSegments2];
  expect([seen.material.dashed, unseen.material.dashed]).toEqual([false, true]);
  const pick = (object: LineSegments2, faceIndex: number) =>
    layer.pick({ object, faceIndex } as unknown as Intersection);
  expect([0, 1, 2].map((i) => pick(seen, i))).toEqual([0, 2, 3].map((index) => ({ kind: "line", index })));
  expect(pick(unseen, 0)).toEqual({ kind: "line", index: 1 });
  expect(pick(unseen, 1)).toBeNull();
});

it("shows a line that the model contradicts like what is rejected", () => {
  expect(colourOf(record("border", 3))).toBe(ORIGIN_COLOURS.border);
  expect(colourOf({ origin: "border", contradiction: "hidden" })).toBe(PALETTE.rejected);
  expect(colourOf(undefined)).toBe(ORIGIN_COLOURS.matched);
});

it("closes rings", () => {
  const ring = [[0, 0, 0] as const, [1, 0, 0] as const, [0, 1, 0] as const];
  expect(sidesOf([ring])).toEqual([0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0]);
});

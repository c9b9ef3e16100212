import type { Intersection } from "three";
import type { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { expect, it } from "vitest";
import { PALETTE } from "../../../src/shared/palette";
import type { LineOrigin, LineRecord } from "../../../src/shared/records";
import { buildLines, colourOf, ORIGIN_COLOURS, opacityOfLine } from "../../../src/stages/lines/linesLayer";
import { sidesOf } from "../../../src/viewer/scene/strokes";

const record = (origin: LineOrigin, views: number, probability = 1): LineRecord => ({
  origin,
  contradiction: null,
  probability,
  by_views: null,
  in_model: null,
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
  expect(colourOf({ origin: "border", contradiction: "improbable" })).toBe(PALETTE.rejected);
  expect(colourOf(undefined)).toBe(ORIGIN_COLOURS.matched);
});

it("draws a line the fainter the less probable it is, but not one that the model contradicts", () => {
  const opacities = [0.99, 0.9, 0.85, 0.6, 0.51, 0.05].map((probability) =>
    opacityOfLine({ probability, contradiction: null }),
  );
  expect(opacities).toEqual([1, 1, 0.8, 0.6, 0.5, 0.2]);
  expect(opacityOfLine({ probability: 0.3, contradiction: "improbable" })).toBe(1);
  expect(opacityOfLine(undefined)).toBe(1);
});

it("keeps lines apart by how faint they are, and dims them all beside a selection", () => {
  const records = [record("matched", 4, 0.6), record("matched", 4), record("border", 3, 0.65)];
  const lines = Float64Array.from(records.flatMap((_, i) => [0, i, 0, 1, i, 0]));
  const layer = buildLines(lines, records, () => []);
  const parts = layer.object.children as LineSegments2[];
  const opacities = () => parts.map(({ material }) => material.opacity);
  expect(opacities()).toEqual([1, 0.6]);
  const pick = (object: LineSegments2 | undefined, faceIndex: number) =>
    layer.pick({ object, faceIndex } as unknown as Intersection);
  expect(pick(parts[0], 0)).toEqual({ kind: "line", index: 1 });
  expect(pick(parts[1], 1)).toEqual({ kind: "line", index: 2 });
  layer.highlight({ kind: "line", index: 0 });
  expect(opacities()[1]).toBeCloseTo(0.6 * (opacities()[0] ?? 0));
  layer.highlight(null);
  expect(opacities()).toEqual([1, 0.6]);
});

it("has no parts without lines", () => {
  expect(buildLines(new Float64Array(), [], () => []).object.children).toEqual([]);
});

it("closes rings", () => {
  const ring = [[0, 0, 0] as const, [1, 0, 0] as const, [0, 1, 0] as const];
  expect(sidesOf([ring])).toEqual([0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0]);
});

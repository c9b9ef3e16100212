import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { type Place, PressWatch } from "../../../src/viewer/tools/press";

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

function watched() {
  const picked: Place[] = [];
  return { picked, watch: new PressWatch((at) => picked.push(at)) };
}

const at = (x: number, y: number, pointerType = "touch", pointerId = 1) => ({
  pointerId,
  pointerType,
  clientX: x,
  clientY: y,
  offsetX: x,
  offsetY: y,
});

it("a click and a tap pick, a drag does not", () => {
  const { watch, picked } = watched();
  watch.down(at(10, 10, "mouse"));
  watch.up(at(12, 10, "mouse"));
  watch.down(at(50, 50, "mouse"));
  watch.move(at(90, 50, "mouse"));
  watch.up(at(50, 50, "mouse"));
  watch.down(at(30, 30));
  watch.up(at(36, 30));
  expect(picked.map(({ x }) => x)).toEqual([12, 36]);
});

it("a finger that rests picks once, where it rests", () => {
  const { watch, picked } = watched();
  watch.down(at(20, 40));
  vi.advanceTimersByTime(600);
  expect(picked).toEqual([{ x: 20, y: 40, isTouch: true }]);
  watch.up(at(20, 40));
  expect(picked).toHaveLength(1);
});

it("two fingers pick nothing, however still they are", () => {
  const { watch, picked } = watched();
  watch.down(at(20, 40, "touch", 1));
  watch.down(at(80, 40, "touch", 2));
  vi.advanceTimersByTime(600);
  watch.up(at(80, 40, "touch", 2));
  watch.up(at(20, 40, "touch", 1));
  expect(picked).toEqual([]);
});

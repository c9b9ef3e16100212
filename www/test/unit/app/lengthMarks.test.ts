import { describe, expect, it } from "vitest";
import {
  isMeasurable,
  marked,
  markIn,
  NO_MARKS,
  nextEnd,
} from "../../../src/app/project/orienting/lengthMarks";

describe("marks of a length", () => {
  const at = (file: string, x: number) => ({ file, x, y: 1 });
  const first = marked(marked(NO_MARKS, 0, at("a.jpg", 1)), 0, at("b.jpg", 2));

  it("has one mark of an end in a photograph", () => {
    expect(marked(first, 0, at("a.jpg", 9))[0]).toEqual([at("b.jpg", 2), at("a.jpg", 9)]);
    expect(markIn(first, 0, "b.jpg")).toEqual(at("b.jpg", 2));
    expect(markIn(first, 1, "b.jpg")).toBeUndefined();
  });

  it("goes on to the other end when one is marked in both photographs", () => {
    expect(nextEnd(first, 0, ["a.jpg", "b.jpg"])).toBe(1);
    expect(nextEnd(first, 0, ["a.jpg", "c.jpg"])).toBe(0);
    const both = marked(marked(first, 1, at("a.jpg", 3)), 1, at("b.jpg", 4));
    expect(nextEnd(both, 0, ["a.jpg", "b.jpg"])).toBe(0);
    expect([isMeasurable(first), isMeasurable(both)]).toEqual([false, true]);
  });
});

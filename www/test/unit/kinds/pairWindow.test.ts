import { describe, expect, it } from "vitest";
import { windowOf } from "../../../src/kinds/lines/pair";

/** An eave along y = 2 at 5 m and a ridge along y = 6 at 8 m: 5 m apart in their plane. */
const LINES = Float64Array.of(1, 2, 5, 11, 2, 5, 3, 6, 8, 9, 6, 8);

describe("the window of a pair of lines", () => {
  it("reaches from line to line, and crossings lie where their positions say", () => {
    const found = windowOf(
      {
        lines: [0, 1],
        rejection: null,
        crossings: [{ view: 4, at: [7, 9], across: [0, 2.5], contrast: 1 }],
        ends: [],
      },
      { lines: LINES },
    );
    expect(found?.outline).toEqual([
      [1, 2, 5],
      [11, 2, 5],
      [11, 6, 8],
      [1, 6, 8],
    ]);
    expect(found?.crossings).toEqual([
      {
        view: 4,
        ends: [
          [7, 2, 5],
          [8, 4, 6.5],
        ],
      },
    ]);
  });

  it("is none where a line is missing", () => {
    expect(
      windowOf({ lines: [0, 2], rejection: null, crossings: [], ends: [] }, { lines: LINES }),
    ).toBeNull();
  });
});

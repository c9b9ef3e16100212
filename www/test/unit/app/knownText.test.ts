/** What the images say of terrain and footprints, in words. */
import { describe, expect, it } from "vitest";
import { knownWords, outcomesOf, shiftWords } from "../../../src/app/parts/knownText";
import type { FootprintFinding, KnownComparison } from "../../../src/shared/records";

const finding = (
  name: string,
  verdict: FootprintFinding["verdict"],
  shift_m?: [number, number],
): FootprintFinding => ({
  name,
  verdict,
  bounds_m: [
    [0, 0],
    [8, 6],
  ],
  roofed: verdict === "agrees" ? 0.97 : 0,
  ...(shift_m !== undefined && { shift_m }),
});

const compared = (change: Partial<KnownComparison>): KnownComparison => ({
  file: "houses.geojson",
  accuracy_m: 0.5,
  verdict: "used",
  belongs: 0.97,
  shift_m: [0, 0, 0],
  contradicted_at: [],
  ...change,
});

describe("what is known in words", () => {
  it("is confirmed, displaced, of another place, or lies elsewhere", () => {
    const words = (change: Partial<KnownComparison>) => knownWords("footprints", compared(change));
    expect(words({})).toMatch(/confirm it \(probability 97 %\).*evidence/);
    expect(words({ verdict: "moved", shift_m: [-1.2, 0.9, 0] })).toMatch(
      /displaced as a whole: it was moved by 1\.20 m west and 0\.90 m north/,
    );
    expect(words({ verdict: "contradicted" })).toMatch(/contradict it as a whole.*counted for little/);
    expect(words({ verdict: "elsewhere" })).toMatch(/was not used/);
  });

  it("says of a terrain model whether it gives the ground", () => {
    const words = (change: Partial<KnownComparison>) => knownWords("terrain", compared(change));
    expect(words({})).toBe("The images confirm it: it gives the ground.");
    expect(words({ contradicted_at: [[2.5, 7.5]] })).toMatch(/gives the ground\. Around some roofs/);
    expect(words({ verdict: "unchecked", shift_m: null })).toMatch(/too little.*gives the ground/);
    expect(words({ verdict: "moved", shift_m: [0, 0, 46.03] })).toMatch(/46\.03 m up/);
    expect(words({ verdict: "contradicted" })).toMatch(/surface model/);
  });
});

describe("a register of footprints in words", () => {
  it("says a shift by the points of the compass", () => {
    expect(shiftWords([0.5, -2.25])).toBe("0.50 m east and 2.25 m south");
    expect(shiftWords([0, -0.25])).toBe("0.25 m south");
    expect(shiftWords([0.001, 0])).toBe("nothing");
  });

  it("counts its footprints by their outcome, with how far they are displaced", () => {
    const footprints = [
      finding("a", "contradicted"),
      finding("b", "agrees", [0.1, 0]),
      finding("c", "shifted", [0.6, 0.8]),
      finding("d", "agrees", [0, 0]),
      finding("e", "shifted", [0, -1.6]),
    ];
    expect(outcomesOf({ footprints })).toEqual([
      { verdict: "agrees", indices: [1, 3], range: "" },
      { verdict: "shifted", indices: [2, 4], range: "1.0 to 1.6 m" },
      { verdict: "contradicted", indices: [0], range: "" },
    ]);
    expect(outcomesOf({ footprints: footprints.slice(2, 3) })[0]?.range).toBe("1.0 m");
    expect(outcomesOf({ footprints: [] })).toEqual([]);
  });
});

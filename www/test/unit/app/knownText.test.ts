/** What the images say of terrain and footprints, in words. */
import { describe, expect, it } from "vitest";
import { outcomesOf, registerWords, shiftWords, terrainWords } from "../../../src/app/parts/knownText";
import type { FootprintFinding, RegisterTrace, TerrainComparison } from "../../../src/shared/records";

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

const register = (change: Partial<RegisterTrace>): RegisterTrace => ({
  file: "houses.geojson",
  verdict: "used",
  belongs: 0.97,
  moved_m: [0, 0],
  footprints: [],
  ...change,
});

const terrain = (
  verdict: TerrainComparison["verdict"],
  images_above_m: number | null,
): TerrainComparison => ({ file: "dtm.tif", accuracy_m: 0.3, verdict, images_above_m });

describe("a register of footprints in words", () => {
  it("belongs here, is displaced, is of another place, or lies elsewhere", () => {
    expect(registerWords(register({}))).toMatch(/belongs to this place \(probability 97 %\)/);
    expect(registerWords(register({ verdict: "moved", moved_m: [-1.2, 0.9] }))).toMatch(
      /displaced as a whole: it was moved by 1\.20 m west and 0\.90 m north/,
    );
    expect(registerWords(register({ verdict: "doubted", belongs: 0.004 }))).toMatch(
      /contradict it as a whole \(probability < 1 % that .*counted for little/,
    );
    expect(registerWords(register({ verdict: "elsewhere", belongs: 0 }))).toMatch(/was not used/);
  });

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

describe("a terrain model in words", () => {
  it("says whether it gives the ground, and how the images compare", () => {
    expect(terrainWords(terrain("confirmed", -0.12))).toMatch(/gives the ground.*0\.12 m below it/);
    expect(terrainWords(terrain("unchecked", null))).toMatch(/too little of the ground/);
    expect(terrainWords(terrain("moved", 46.03))).toMatch(/datums taken out.*46\.03 m above it/);
    expect(terrainWords(terrain("surface", 0))).toMatch(/^Not used: .*surface model/);
    expect(terrainWords(terrain("elsewhere", null))).toMatch(/^Not used: .*half of the place/);
  });
});

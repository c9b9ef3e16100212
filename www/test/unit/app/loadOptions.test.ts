import { describe, expect, it } from "vitest";
import { loadOptions, parseEpsg, parseHeight, parseRegion } from "../../../src/app/settings/loadOptions";
import { systemWords } from "../../../src/app/settings/referenceSystems";
import { NO_OPTIONS } from "../../../src/app/state/project";
import type { Inspection } from "../../../src/shared/records";

const image = (path: string) => ({ path, name: path.replace("in/", ""), size: null, orientation: null });
const photographs = ["in/a.jpg", "in/b.jpg", "in/c.jpg"];
const inspection = {
  images: photographs.map(image),
  files: [...photographs, "dtm.asc", "houses.geojson"].map((path) => ({ path })),
} as unknown as Inspection;

describe("run options", () => {
  it("say nothing where nothing is asked for", () => {
    expect(loadOptions(NO_OPTIONS, inspection)).toEqual({});
  });

  it("name the views that are left, the orientation, region and ground", () => {
    const wanted = {
      orientation: "x/b.out",
      leftOut: ["in/b.jpg", "dtm.asc"],
      roi: [1, 2, 3, 4] as const,
      terrain: null,
      footprints: "houses.geojson",
      groundZ: 0,
      applyFix: true,
      ignoreCheck: true,
      tileM: 50,
      isAtOnce: false,
      reduction: 2,
      epsg: 25832,
    };
    expect(loadOptions({ ...wanted, roi: [...wanted.roi] }, inspection)).toEqual({
      orientation: "x/b.out",
      views: ["a.jpg", "c.jpg"],
      roi: [1, 2, 3, 4],
      footprints: "houses.geojson",
      unused: ["dtm.asc"],
      groundZ: 0,
      reduction: 2,
      applyFix: true,
      ignoreCheck: true,
      epsg: 25832,
    });
  });

  it("name no file that is gone, and all views where only terrain is left out", () => {
    const wanted = { ...NO_OPTIONS, leftOut: ["dtm.asc", "gone.asc"], footprints: "gone.geojson" };
    expect(loadOptions(wanted, inspection)).toEqual({ unused: ["dtm.asc"] });
  });

  it("read a region with any separators, and say what is wrong with it", () => {
    expect(parseRegion("1, 2;3  4.5")).toEqual({ value: [1, 2, 3, 4.5] });
    expect(parseRegion("  ")).toEqual({ value: null });
    expect(parseRegion("1,2,3")).toHaveProperty("error");
    expect(parseRegion("1,2,x,4")).toHaveProperty("error");
    expect(parseRegion("3,2,1,4")).toHaveProperty("error");
  });

  it("read a height; zero is one, nothing is none", () => {
    expect(parseHeight("0")).toEqual({ value: 0 });
    expect(parseHeight("")).toEqual({ value: null });
    expect(parseHeight("12 m")).toHaveProperty("error");
    expect(parseEpsg("25832")).toEqual({ value: 25832 });
    expect(parseEpsg(" epsg:2056 ")).toEqual({ value: 2056 });
    expect(parseEpsg("")).toEqual({ value: null });
    expect(parseEpsg("UTM 32")).toHaveProperty("error");
  });
});

describe("a reference system", () => {
  it("is found by its code, or by words of its name", () => {
    expect([parseEpsg("EPSG:25832"), parseEpsg("etrs89 utm 32n"), parseEpsg("lambert-93")]).toEqual([
      { value: 25832 },
      { value: 25832 },
      { value: 2154 },
    ]);
    expect(parseEpsg("Gauss")).toEqual({ error: expect.stringContaining("31467 Germany") });
    expect(parseEpsg("no such")).toEqual({ error: expect.stringContaining("a code such as") });
  });

  it("is doubted where the coordinates have another size", () => {
    expect(systemWords(25832, [691_000, 5_334_000, 520])).toBe("ETRS89 / UTM zone 32N");
    expect(systemWords(31468, [691_000, 5_334_000, 520])).toContain("Is it another system?");
    expect(systemWords(4326, [691_000, 5_334_000, 520])).toBe("");
  });
});

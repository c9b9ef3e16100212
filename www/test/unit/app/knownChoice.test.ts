/** Which terrain model and footprints are taken, and what is asked for when a person takes another or none. */
import { describe, expect, it } from "vitest";
import { choiceOf, knownFiles } from "../../../src/app/project/known/knownChoice";
import { NO_OPTIONS } from "../../../src/app/state/project";
import type { FileReport } from "../../../src/shared/records";

const file = (path: string, kind: FileReport["kind"]): FileReport => ({ path, kind, description: "" });
const files = [
  file("a.jpg", "image"),
  file("dtm.asc", "terrain"),
  file("old.geojson", "footprints"),
  file("new.geojson", "footprints"),
];
const wordsOf = (wanted: Parameters<typeof knownFiles>[1], known: Parameters<typeof knownFiles>[2]) =>
  Object.fromEntries(knownFiles({ files }, wanted, known).map(({ path, words }) => [path, words]));

describe("files that are known beforehand", () => {
  it("say what they are taken as, or why they are not", () => {
    expect(wordsOf(NO_OPTIONS, { terrain: "dtm.asc", footprints: null, point_cloud: null })).toEqual({
      "dtm.asc": "taken as the terrain",
      "old.geojson": "not taken: there are several; choose one",
      "new.geojson": "not taken: there are several; choose one",
    });
    const wanted = { ...NO_OPTIONS, groundZ: 100, leftOut: ["old.geojson"] };
    expect(wordsOf(wanted, { terrain: null, footprints: "new.geojson", point_cloud: null })).toEqual({
      "dtm.asc": "not taken: the height of the ground is stated",
      "old.geojson": "left out",
      "new.geojson": "taken as the footprints",
    });
    expect(wordsOf(wanted, { terrain: null, footprints: null, point_cloud: null })["new.geojson"]).toMatch(
      /result of this program/,
    );
    expect(wordsOf(NO_OPTIONS, null)["dtm.asc"]).toBe("");
  });

  it("say what a point cloud is taken for", () => {
    const words = (terrain: string | null, cloud: string | null) =>
      wordsOf(NO_OPTIONS, { terrain, footprints: null, point_cloud: cloud })["dtm.asc"];
    expect(words("dtm.asc", "dtm.asc")).toBe("taken as the terrain, and for its points on roofs");
    expect(words(null, "dtm.asc")).toBe("taken for its points on roofs");
    expect(words("dtm.asc", null)).toBe("taken as the terrain");
  });

  it("are named once they are chosen, and neither named nor taken once they are left out", () => {
    const [, old] = knownFiles({ files }, NO_OPTIONS, null);
    const chosen = {
      ...NO_OPTIONS,
      ...choiceOf(old as never, true, { ...NO_OPTIONS, leftOut: ["old.geojson"] }),
    };
    expect(chosen).toEqual({ ...NO_OPTIONS, footprints: "old.geojson" });
    expect({ ...chosen, ...choiceOf(old as never, false, chosen) }).toEqual({
      ...NO_OPTIONS,
      leftOut: ["old.geojson"],
    });
  });
});

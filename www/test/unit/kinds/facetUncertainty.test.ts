import { describe, expect, it } from "vitest";
import { rowsOf } from "../../../src/kinds/kinds";
import { FACETS } from "../../fake/ridgeline";
import { about } from "./about";

const rowsOfFacet = (facet: (typeof FACETS)[number]) => {
  const rows = rowsOf({ kind: "facet", index: 0 }, about({ facets: [facet] }));
  return new Map(rows.map(([label, value]) => [label, value]));
};

describe("how well a facet is known", () => {
  const known = FACETS[0] as (typeof FACETS)[number];

  it("stands behind its slope, height and corners", () => {
    const rows = rowsOfFacet(known);
    expect(rows.get("Slope")).toMatch(/ ± 0\.40°$/);
    expect(rows.get("Height in its middle")).toBe("± 0.05 m");
    // The root mean square of 0.03 and 0.04 m.
    expect(rows.get("Corners")).toBe("4 ± 0.04 m");
  });

  it("is not told where the photographs show too few edges", () => {
    const rows = rowsOfFacet({ ...known, uncertainty: null });
    expect(rows.get("Slope")).not.toContain("±");
    expect(rows.has("Height in its middle")).toBe(false);
    expect(rows.get("Corners")).toBe("4");
  });
});

import { describe, expect, it } from "vitest";
import { KINDS } from "../../../src/kinds/kinds";
import { formatSelection, KIND_NAMES, parseSelection, type Selection } from "../../../src/shared/selection";
import { METHODS } from "../../../src/shared/stages";
import { tabsOf } from "../../../src/stages/catalogue";
import { STAGE_FACTS } from "../../../src/stages/list";

/** One of each kind, with the fields that its text names. */
const ONES: readonly Selection[] = [
  { kind: "view", index: 3 },
  { kind: "segment", view: 0, index: 44 },
  { kind: "rejectedSegment", view: 2, index: 9 },
  { kind: "region", view: 3, index: 1 },
  { kind: "line", index: 12 },
  { kind: "side", line: 12, side: "left" },
  { kind: "halfplane", index: 0 },
  { kind: "pair", index: 5 },
  { kind: "cluster", plane: 1, index: 7 },
  { kind: "dense", index: 999999999 },
  { kind: "coplanar", index: 3 },
  { kind: "corner", index: 3 },
  { kind: "group", index: 9 },
  { kind: "facet", index: 0 },
  { kind: "rejectedFacet", index: 4 },
  { kind: "uncoveredRoof", index: 1 },
  { kind: "refinement", index: 2 },
  { kind: "relation", building: 2, index: 11 },
  { kind: "footprint", index: 3 },
];
const WALL = { kind: "surface", surface: "wall", building: 1, areaM2: 3 } as const;

describe("the kinds of things", () => {
  it("are in one list, a file each", () => {
    expect(Object.keys(KINDS).sort()).toEqual([...KIND_NAMES].sort());
    expect([...ONES, { ...WALL, facet: 0 }].map(({ kind }) => kind).sort()).toEqual([...KIND_NAMES].sort());
  });

  it.each(ONES)("come back from their text: $kind", (one) => {
    expect(parseSelection(formatSelection(one))).toEqual(one);
  });

  it("have the words that links were written with", () => {
    expect(ONES.map(formatSelection)).toEqual([
      "view:3",
      "segment:0.44",
      "rejected:2.9",
      "region:3.1",
      "line:12",
      "side:12.left",
      "halfplane:0",
      "pair:5",
      "cluster:1.7",
      "dense:999999999",
      "coplanar:3",
      "corner:3",
      "group:9",
      "facet:0",
      "withdrawn:4",
      "uncovered:1",
      "refinement:2",
      "relation:2.11",
      "footprint:3",
    ]);
  });

  it("read a surface of the model back as its facet, and name none that has no facet", () => {
    expect(parseSelection(formatSelection({ ...WALL, facet: 6 }))).toEqual({ kind: "facet", index: 6 });
    expect(formatSelection({ ...WALL, facet: null })).toBeNull();
  });

  it.each([
    null,
    "",
    "line",
    "line:",
    "line:-1",
    "line:1e9",
    "line:1234567890",
    "line:1.2",
    "line:1.left",
    "line:1 ",
    "line:1\n",
    "Line:1",
    "segment:1",
    "segment:1.left",
    "segment:1.2.3",
    "side:3",
    "side:3.4",
    "side:3.up",
    "surface:1",
    "rejectedSegment:1.2",
    "constructor:1",
    "__proto__:1",
    "toString:1",
    ":1",
    "<script>:1",
  ])("take nothing from %j", (text) => {
    expect(parseSelection(text)).toBeNull();
  });

  it("are gone through in the tabs, one kind in each", () => {
    expect(
      [...new Set(METHODS.flatMap(tabsOf))].filter((tab) => STAGE_FACTS[tab].about === undefined),
    ).toEqual([]);
  });
});

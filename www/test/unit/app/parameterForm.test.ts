import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import {
  changedParams,
  type ParamField,
  paramSections,
  paramsOf,
  parseField,
  wantedFields,
  withParam,
} from "../../../src/app/settings/parameterForm";
import * as core from "../../../src/pkg/ridgeline.js";
import type { ParamTree } from "../../../src/shared/paramTree";
import { METHODS, STAGES } from "../../../src/shared/stages";
import { firstStageOf, stagesOf } from "../../../src/stages/catalogue";

const DEFAULTS = {
  segments: { min_length_px: 15, area_m2: 2, closed: true },
  lines3d: {},
  sweep: { max_theta_deg: 75, steps: [1, 2] },
};

function field(group: string, key: string, values = DEFAULTS): ParamField {
  const section = paramSections(DEFAULTS, values).find((one) => one.path === group);
  const found = section?.fields.find((one) => one.key === key);
  if (found === undefined) {
    throw new Error(`no field ${group}.${key}`);
  }
  return found;
}

describe("paramSections", () => {
  it("leaves out stages without parameters", () => {
    expect(paramSections(DEFAULTS, DEFAULTS).map(({ path }) => path)).toEqual(["segments", "sweep"]);
  });

  it("makes no section of a single value", () => {
    const withMethod: ParamTree = JSON.parse(JSON.stringify({ method: "lines", ...DEFAULTS }));
    expect(paramSections(withMethod, withMethod).map(({ path }) => path)).toEqual(["segments", "sweep"]);
  });

  it("reads the unit from the name", () => {
    expect(field("segments", "min_length_px")).toMatchObject({ label: "Minimum length", unit: "px" });
    expect(field("segments", "area_m2")).toMatchObject({ label: "Area", unit: "m²" });
    expect(field("sweep", "max_theta_deg")).toMatchObject({ label: "Maximum theta", unit: "°" });
  });

  it("marks what differs from the default, and only that", () => {
    const values = { ...DEFAULTS, segments: { ...DEFAULTS.segments, min_length_px: 12 } };
    expect(field("segments", "min_length_px", values)).toMatchObject({
      changed: true,
      value: 12,
      fallback: 15,
    });
    expect(field("segments", "closed", values).changed).toBe(false);
    expect(paramSections(DEFAULTS, values)[0]?.changed).toBe(1);
  });

  it("compares lists by their content", () => {
    const values = { ...DEFAULTS, sweep: { max_theta_deg: 75, steps: [1, 2] } };
    expect(field("sweep", "steps", values).changed).toBe(false);
  });
});

describe("groups inside groups", () => {
  const nested: ParamTree = JSON.parse(
    '{"segments": {"min_length_px": 15, "edgels": {"low": 2}}, "objectspace": {"oris": {"noise": 4}}, "method": "lines"}',
  );

  it("are sections of their own, and those of the other method are left out", () => {
    expect(paramSections(nested, nested).map(({ path, title }) => [path, title])).toEqual([
      ["segments", "Segments"],
      ["segments.edgels", "Segments: edgels"],
    ]);
    const other = { ...nested, method: "rectangles" as unknown as ParamTree[string] };
    expect(paramSections(nested, other).map(({ path }) => path)).toEqual(["objectspace.oris"]);
    const both = { ...nested, method: "combined" as unknown as ParamTree[string] };
    expect(paramSections(nested, both)).toHaveLength(3);
  });

  it("are changed by path, and what was changed makes the same parameters again", () => {
    const changed = withParam(nested, "segments.edgels.low", 3);
    expect(changed["segments"]).toEqual({ min_length_px: 15, edgels: { low: 3 } });
    expect(nested["segments"]).toMatchObject({ edgels: { low: 2 } });
    expect(changedParams(nested, changed)).toEqual({ "segments.edgels.low": 3 });
    expect(paramsOf(nested, changedParams(nested, changed))).toEqual(changed);
  });

  it("are not changed by a link that names what is not there, or of another type", () => {
    const wrong = {
      "segments.edgels": 3,
      "segments.new": 1,
      "segments.min_length_px": "15",
      "__proto__.x": 1,
    };
    expect(paramsOf(nested, wrong)).toEqual(nested);
  });
});

describe("parseField", () => {
  it("takes numbers, with either decimal mark", () => {
    expect(parseField(field("segments", "min_length_px"), " 12.5 ")).toEqual({ value: 12.5 });
    expect(parseField(field("segments", "min_length_px"), "0,4")).toEqual({ value: 0.4 });
  });

  it.each(["", "abc", "1e999", "NaN", "1 2"])("rejects %j as a number", (text) => {
    expect(parseField(field("segments", "min_length_px"), text)).toHaveProperty("error");
  });

  it("takes JSON for lists and rejects what is none", () => {
    expect(parseField(field("sweep", "steps"), "[3]")).toEqual({ value: [3] });
    expect(parseField(field("sweep", "steps"), "[3")).toHaveProperty("error");
  });
});

describe("the form of a method", () => {
  core.initSync({ module: readFileSync(new URL("../../../src/pkg/ridgeline_bg.wasm", import.meta.url)) });
  const defaults = core.Session.defaultParams() as unknown as ParamTree;
  /** The paths of all single values below one, lists among them. */
  const below = (path: string, value: unknown): string[] =>
    typeof value === "object" && value !== null && !Array.isArray(value)
      ? Object.entries(value).flatMap(([key, inner]) => below(`${path}.${key}`, inner))
      : [path];
  const at = (path: string) =>
    path.split(".").reduce<unknown>((group, key) => (group as ParamTree)[key], defaults);

  it.each(METHODS)("shows every parameter that a stage of %s reads, and no other", (method) => {
    const values = { ...defaults, method: method as unknown as ParamTree[string] };
    const shown = paramSections(defaults, values).flatMap(({ path, fields }) =>
      fields.map(({ key }) => `${path}.${key}`),
    );
    const read = STAGES.filter(({ methods }) => (methods as readonly string[]).includes(method))
      .flatMap(({ reads }) => reads as readonly string[])
      // Corrections are no parameters of the form: they have a list of their own.
      .filter((path) => path !== "corrections")
      .flatMap((path) => below(path, at(path)));
    expect([...shown].sort()).toEqual([...new Set(read)].sort());
  });

  it("has a point cloud's in the default method", () => {
    const titles = paramSections(defaults, defaults).map(({ title }) => title);
    expect(titles).toContain("Point cloud");
  });
});

describe("firstStageOf", () => {
  const stages = stagesOf("lines");

  it("finds the stage that a group changes first", () => {
    expect(firstStageOf("sweep", stages)).toBe(5);
    expect(firstStageOf("point_cloud", stages)).toBe(6);
    expect(firstStageOf("texture", stages)).toBe(11);
    expect(firstStageOf("adjustment", stages)).toBe(stages.indexOf("matches"));
  });

  it("tells parameters of one group apart, and leaves the other method alone", () => {
    const rectangles = stagesOf("rectangles");
    expect(firstStageOf("objectspace.planes.min_area_m2", rectangles)).toBe(4);
    expect(firstStageOf("objectspace.planes.min_height_m", rectangles)).toBe(1);
    expect(firstStageOf("point_cloud", rectangles)).toBe(rectangles.length);
    // Beside edges that are drawn by hand half-planes are swept with every method.
    expect(firstStageOf("sweep.min_similarity", rectangles)).toBe(rectangles.indexOf("corrections"));
  });

  it("outdates everything for a group it does not know", () => {
    expect(firstStageOf("novel", stages)).toBe(0);
  });
});

describe("wantedFields", () => {
  it("stand in the order of their list, as far as the method reads them", () => {
    const all: ParamTree = {
      segments: { min_length_px: 15, area_m2: 2 },
      roof: { min_area_m2: 1.5 },
      objectspace: { planes: { min_area_m2: 3 } },
    };
    const paths = (method: string) =>
      wantedFields(paramSections(all, { ...all, method: method as unknown as ParamTree[string] })).map(
        ({ section, field: { key } }) => `${section.path}.${key}`,
      );
    expect(paths("lines")).toEqual(["roof.min_area_m2", "segments.min_length_px"]);
    expect(paths("rectangles")).toEqual(["objectspace.planes.min_area_m2"]);
  });
});

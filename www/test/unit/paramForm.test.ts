import { describe, expect, it } from "vitest";
import { type ParamField, paramSections, parseField } from "../../src/app/paramForm";
import { firstStageOf } from "../../src/app/stages";
import type { Params } from "../../src/shared/results";

const DEFAULTS = {
  segments: { min_length_px: 15, area_m2: 2, closed: true },
  lines3d: {},
  sweep: { max_theta_deg: 75, steps: [1, 2] },
};

function field(group: string, key: string, values = DEFAULTS): ParamField {
  const section = paramSections(DEFAULTS, values).find((one) => one.group === group);
  const found = section?.fields.find((one) => one.key === key);
  if (found === undefined) {
    throw new Error(`no field ${group}.${key}`);
  }
  return found;
}

describe("paramSections", () => {
  it("leaves out stages without parameters", () => {
    expect(paramSections(DEFAULTS, DEFAULTS).map(({ group }) => group)).toEqual(["segments", "sweep"]);
  });

  it("makes no section of a single value", () => {
    const withMethod: Params = JSON.parse(JSON.stringify({ method: "lines", ...DEFAULTS }));
    expect(paramSections(withMethod, withMethod).map(({ group }) => group)).toEqual(["segments", "sweep"]);
  });

  it("reads the unit from the name", () => {
    expect(field("segments", "min_length_px")).toMatchObject({ label: "Min length", unit: "px" });
    expect(field("segments", "area_m2")).toMatchObject({ label: "Area", unit: "m²" });
    expect(field("sweep", "max_theta_deg")).toMatchObject({ label: "Max theta", unit: "°" });
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

describe("parseField", () => {
  it("takes numbers, with either decimal mark", () => {
    expect(parseField(field("segments", "min_length_px"), " 12.5 ")).toEqual({ value: 12.5 });
    expect(parseField(field("segments", "min_length_px"), "0,4")).toEqual({ value: 0.4 });
  });

  it.each(["", "abc", "1e999", "NaN", "1 2"])("refuses %j as a number", (text) => {
    expect(parseField(field("segments", "min_length_px"), text)).toHaveProperty("error");
  });

  it("takes JSON for lists and refuses what is none", () => {
    expect(parseField(field("sweep", "steps"), "[3]")).toEqual({ value: [3] });
    expect(parseField(field("sweep", "steps"), "[3")).toHaveProperty("error");
  });
});

describe("firstStageOf", () => {
  const stages = ["segments", "matches", "lines", "halfplanes", "facets", "model"];

  it("finds the stage that a group changes first", () => {
    expect(firstStageOf("sweep", stages)).toBe(3);
    expect(firstStageOf("texture", stages)).toBe(5);
  });

  it("outdates everything for a group it does not know", () => {
    expect(firstStageOf("novel", stages)).toBe(0);
  });
});

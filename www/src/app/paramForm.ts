/** The form of the parameters, made from whatever defaults the core gives: nothing is retyped here. */
import type { ParamGroup, Params, ParamValue } from "../shared/results";

export interface ParamField {
  key: string;
  label: string;
  unit: string;
  kind: "number" | "boolean" | "text" | "json";
  value: ParamValue;
  fallback: ParamValue;
  changed: boolean;
}

export interface ParamSection {
  group: string;
  fields: ParamField[];
  changed: number;
}

/** Suffixes of the core's names, longest first, and the unit that they stand for. */
const UNITS: readonly (readonly [string, string])[] = [
  ["_px", "px"],
  ["_deg", "°"],
  ["_m2", "m²"],
  ["_m", "m"],
  ["_s", "s"],
];

const GROUP_TITLES: Record<string, string> = {
  segments: "Segments",
  matching: "Matching",
  lines3d: "3D lines",
  sweep: "Half-plane sweep",
  roof: "Grouping and facets",
  texture: "Texture",
};

export function groupTitle(group: string): string {
  return GROUP_TITLES[group] ?? words(group);
}

/** One section a stage, in the core's order; a stage without parameters has none, nor has a single value beside the
 * groups. */
export function paramSections(defaults: Params, values: Params): ParamSection[] {
  return Object.entries(defaults)
    .filter(([, fallback]) => typeof fallback === "object" && Object.keys(fallback).length > 0)
    .map(([group, fallback]) => {
      const fields = paramFields(fallback, values[group] ?? {});
      return { group, fields, changed: fields.filter(({ changed }) => changed).length };
    });
}

/** The value of a field's text, or why it cannot be one. */
export function parseField(field: ParamField, text: string): { value: ParamValue } | { error: string } {
  switch (field.kind) {
    case "number": {
      const value = Number(text.trim().replace(",", "."));
      return text.trim() === "" || !Number.isFinite(value) ? { error: "A number is expected" } : { value };
    }
    case "boolean":
      return { value: text === "true" };
    case "text":
      return { value: text };
    case "json":
      return parseJson(text);
  }
}

/** The text that shows a value in its field. */
export function fieldText(value: ParamValue): string {
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

function paramFields(fallback: ParamGroup, values: ParamGroup): ParamField[] {
  return Object.entries(fallback).map(([key, standard]) => {
    const value = values[key] ?? standard;
    const { label, unit } = labelAndUnit(key);
    return {
      key,
      label,
      unit,
      kind: fieldKind(standard),
      value,
      fallback: standard,
      changed: fieldText(value) !== fieldText(standard),
    };
  });
}

function fieldKind(value: ParamValue): ParamField["kind"] {
  switch (typeof value) {
    case "number":
      return "number";
    case "boolean":
      return "boolean";
    case "string":
      return "text";
    default:
      return "json";
  }
}

function labelAndUnit(key: string): { label: string; unit: string } {
  const found = UNITS.find(([suffix]) => key.endsWith(suffix) && key.length > suffix.length);
  if (found === undefined) {
    return { label: words(key), unit: "" };
  }
  const [suffix, unit] = found;
  return { label: words(key.slice(0, -suffix.length)), unit };
}

function words(key: string): string {
  const text = key.replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function parseJson(text: string): { value: ParamValue } | { error: string } {
  try {
    return { value: JSON.parse(text) as ParamValue };
  } catch {
    return { error: "JSON is expected" };
  }
}

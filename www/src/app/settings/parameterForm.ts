/** The form of the parameters, made from the core's own defaults, of what the stages of the method read. */
import type { ParamGroup, ParamTree, ParamValue } from "../../shared/paramTree";
import type { Method } from "../../shared/stages";
import { isReadBy, methodOf, SECTION_TITLES } from "../../stages/catalogue";
import { type Parsed, parseNumber } from "../parts/TextField";

export interface ParamField {
  key: string;
  label: string;
  unit: string;
  kind: "number" | "boolean" | "choice" | "text" | "json";
  /** The words that a choice may be. */
  choices: readonly string[];
  value: ParamValue;
  fallback: ParamValue;
  changed: boolean;
}

export interface ParamSection {
  /** Where its fields stand: names joined by dots. */
  path: string;
  title: string;
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

/** Fields that are one of a few words. */
const CHOICES: Record<string, readonly string[]> = {
  acceptance: ["printed", "posterior", "both"],
};

/**
 * What a person most often wants to change, by what it does to the result, and between which values in which steps it is
 * dragged; all else stands in its stage's section.
 */
export const WANTED: Readonly<Record<string, readonly [low: number, high: number, step: number] | null>> = {
  "roof.min_area_m2": [0.5, 20, 0.5],
  "roof.min_height_m": [0, 5, 0.1],
  "roof.refine.refine": null,
  "segments.min_length_px": [8, 60, 1],
  "matching.min_views": [3, 6, 1],
  "sweep.min_similarity": [0, 1, 0.05],
  "objectspace.planes.min_area_m2": [0.5, 20, 0.5],
  "objectspace.clusters.min_views": [2, 6, 1],
  "texture.max_atlas_px": [256, 4096, 256],
  "texture.jpeg_quality": [10, 100, 5],
};

/** The wanted fields that the method reads, each with the section that it is of. */
export function wantedFields(
  sections: readonly ParamSection[],
): { section: ParamSection; field: ParamField }[] {
  return Object.keys(WANTED).flatMap((path) => {
    const at = path.lastIndexOf(".");
    const section = sections.find((one) => one.path === path.slice(0, at));
    const field = section?.fields.find(({ key }) => key === path.slice(at + 1));
    return section === undefined || field === undefined ? [] : [{ section, field }];
  });
}

/** One section a group, groups inside groups apart, in the core's order; only what a stage of the method reads. */
export function paramSections(defaults: ParamTree, values: ParamTree): ParamSection[] {
  const method = methodOf(values);
  return Object.entries(defaults)
    .filter(([, fallback]) => isGroup(fallback))
    .flatMap(([name, fallback]) => sectionsOf(method, name, fallback, values[name] ?? {}));
}

function sectionsOf(method: Method, path: string, defaults: ParamGroup, values: ParamGroup): ParamSection[] {
  const own = Object.entries(defaults).filter(
    ([key, value]) => !isGroup(value) && isReadBy(method, `${path}.${key}`),
  );
  const inner = Object.entries(defaults).filter(([, value]) => isGroup(value));
  const fields = own.map(([key, fallback]) => paramField(key, fallback, values[key] ?? fallback));
  const section = {
    path,
    title: SECTION_TITLES[path] ?? innerTitle(path),
    fields,
    changed: fields.filter(({ changed }) => changed).length,
  };
  return [
    ...(fields.length > 0 ? [section] : []),
    ...inner.flatMap(([key, group]) =>
      sectionsOf(method, `${path}.${key}`, group as ParamGroup, (values[key] ?? group) as ParamGroup),
    ),
  ];
}

/** "Segments: edgels". */
function innerTitle(path: string): string {
  const at = path.lastIndexOf(".");
  const outer = SECTION_TITLES[path.slice(0, at)];
  const own = path.slice(at + 1).replaceAll("_", " ");
  return outer === undefined ? words(path.slice(at + 1)) : `${outer}: ${own}`;
}

/** The parameters with another value at a path of names. */
export function withParam(values: ParamTree, path: string, value: ParamValue): ParamTree {
  const [first, ...rest] = path.split(".") as [string, ...string[]];
  const set = (group: ParamValue | undefined, names: readonly string[]): ParamValue => {
    const [name, ...deeper] = names;
    return name === undefined
      ? value
      : { ...(group as ParamGroup), [name]: set((group as ParamGroup)[name], deeper) };
  };
  return { ...values, [first]: set(values[first] ?? {}, rest) as ParamGroup };
}

/** A parameter in words, with its group: "Half-plane sweep: Min similarity". */
export function paramName(path: string, withUnit = true): string {
  const at = path.lastIndexOf(".");
  const [group, key] = [path.slice(0, at), path.slice(at + 1)];
  const { label, unit } = labelAndUnit(key);
  return `${SECTION_TITLES[group] ?? innerTitle(group)}: ${label}${unit === "" || !withUnit ? "" : ` (${unit})`}`;
}

/** What differs from the defaults, by path: what a link carries. */
export function changedParams(defaults: ParamTree, values: ParamTree): Record<string, ParamValue> {
  const changed: Record<string, ParamValue> = {};
  const walk = (path: string, fallback: ParamValue, value: ParamValue) => {
    if (isGroup(fallback) && isGroup(value)) {
      for (const [key, inner] of Object.entries(fallback)) {
        walk(path === "" ? key : `${path}.${key}`, inner, value[key] ?? inner);
      }
    } else if (fieldText(value) !== fieldText(fallback)) {
      changed[path] = value;
    }
  };
  walk("", defaults, values);
  return changed;
}

/** The defaults with what a link carries; paths that the core does not know are left out. */
export function paramsOf(defaults: ParamTree, changed: Record<string, ParamValue>): ParamTree {
  let values = structuredClone(defaults);
  for (const [path, value] of Object.entries(changed)) {
    const known = path
      .split(".")
      .reduce<ParamValue | undefined>((group, name) => (isGroup(group) ? group[name] : undefined), defaults);
    if (known !== undefined && !isGroup(known) && (known === null || typeof known === typeof value)) {
      values = withParam(values, path, value);
    }
  }
  return values;
}

/** The value of a field's text, or why it cannot be one. */
export function parseField(field: ParamField, text: string): Parsed<ParamValue> {
  switch (field.kind) {
    case "number":
      return parseNumber(text);
    case "boolean":
      return { value: text === "true" };
    case "choice":
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

function paramField(key: string, fallback: ParamValue, value: ParamValue): ParamField {
  const { label, unit } = labelAndUnit(key);
  return {
    key,
    label,
    unit,
    kind: key in CHOICES ? "choice" : fieldKind(fallback),
    choices: CHOICES[key] ?? [],
    value,
    fallback,
    changed: fieldText(value) !== fieldText(fallback),
  };
}

function isGroup(value: ParamValue | undefined): value is ParamGroup {
  return typeof value === "object" && value !== null && !Array.isArray(value);
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

/** What the core's names shorten. */
const SHORT_WORDS: Record<string, string> = {
  poi: "interest point",
  min: "minimum",
  max: "maximum",
  rms: "RMS",
  ln: "log",
  chi2: "χ²",
};

function words(key: string): string {
  const text = key
    .split("_")
    .map((word) => SHORT_WORDS[word] ?? word)
    .join(" ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}

function parseJson(text: string): Parsed<ParamValue> {
  try {
    return { value: JSON.parse(text) as ParamValue };
  } catch {
    return { error: "JSON is expected" };
  }
}

/** The numbers behind the figures as tables: a record a row, lengths in metres, angles in degrees, places in images in pixels. */
import type { Vec3 } from "../../../shared/records";
import { numberOf } from "../../../shared/selection";

export type Row = Record<string, string | number | boolean | null>;

/** The ends of a 3D line. */
export function endsOf(lines: Float64Array | null, line: number): Row {
  const [x0, y0, z0, x1, y1, z1] = lines?.subarray(6 * line, 6 * line + 6) ?? [];
  const all = { x0, y0, z0, x1, y1, z1 };
  return Object.fromEntries(Object.entries(all).map(([name, value]) => [name, value ?? null]));
}

export function planeOf({ normal, d }: { normal: Vec3; d: number }): Row {
  const [nx, ny, nz] = normal;
  return { nx, ny, nz, d };
}

/** What a record names by its index. */
const NAMED = /^(building|candidate|corner|facet|first|group|line|match|plane|region|second|segment|set)$/;

/** Records that name things by their numbers. */
export function numbered(rows: readonly Row[]): Row[] {
  const of = ([name, value]: [string, Row[string]]) =>
    [name, typeof value === "number" && NAMED.test(name) ? numberOf(value) : value] as const;
  return rows.map((row) => Object.fromEntries((Object.entries(row) as [string, Row[string]][]).map(of)));
}

/** RFC 4180: commas, quotes where they are needed, lines end with CR LF. */
export function csvOf(rows: readonly Row[]): string {
  const names = [...new Set(rows.flatMap((row) => Object.keys(row)))];
  const field = (value: unknown) => {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const line = (values: readonly unknown[]) => `${values.map(field).join(",")}\r\n`;
  return line(names) + rows.map((row) => line(names.map((name) => row[name]))).join("");
}

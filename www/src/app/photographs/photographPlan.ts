/** What a photograph's header (EXIF) says of where, when and with what it was taken. */
import type { InputFile } from "../../shared/calls";

export interface PhotographFacts {
  path: string;
  camera: string | null;
  focalMm: number | null;
  taken: Date | null;
  /** Degrees, WGS 84; metres. */
  position: { latitude: number; longitude: number; altitudeM: number | null } | null;
}

/** A photograph in plan, metres east and north of the middle of all. */
export interface PlanPoint {
  path: string;
  east: number;
  north: number;
}

/** The header of a JPEG stands at its front; nothing more of a large file is read. */
const HEADER_BYTES = 256 * 1024;
const METRES_PER_DEGREE = 111_320;

/** What the header says; nothing where there is none. */
export async function readFacts({ path, blob }: InputFile): Promise<PhotographFacts> {
  const found = await headerOf(blob);
  const { latitude, longitude, GPSAltitude: altitude, DateTimeOriginal: taken } = found;
  const camera = [found["Make"], found["Model"]].filter((part) => typeof part === "string").join(" ");
  return {
    path,
    camera: camera === "" ? null : camera,
    focalMm: numberOrNull(found["FocalLength"]),
    taken: taken instanceof Date && !Number.isNaN(taken.getTime()) ? taken : null,
    position:
      typeof latitude === "number" && typeof longitude === "number"
        ? { latitude, longitude, altitudeM: numberOrNull(altitude) }
        : null,
  };
}

interface Header extends Record<string, unknown> {
  latitude?: unknown;
  longitude?: unknown;
  GPSAltitude?: unknown;
  DateTimeOriginal?: unknown;
}

async function headerOf(blob: Blob): Promise<Header> {
  try {
    // Fetched when it is needed: most projects come with their orientation.
    const { parse } = await import("exifr");
    return ((await parse(await blob.slice(0, HEADER_BYTES).arrayBuffer())) as Header | undefined) ?? {};
  } catch {
    return {};
  }
}

function numberOrNull(value: unknown): number | null {
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

/** Positions in plan, in the order in which they were taken: the way that was flown. */
export function planOf(all: readonly PhotographFacts[]): PlanPoint[] {
  const placed = all.flatMap(({ path, position, taken }) =>
    position === null ? [] : [{ path, ...position, time: taken?.getTime() ?? 0 }],
  );
  const mean = (values: readonly number[]) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const latitude = mean(placed.map((one) => one.latitude));
  const longitude = mean(placed.map((one) => one.longitude));
  const shrink = Math.cos((latitude * Math.PI) / 180);
  return placed
    .sort((a, b) => a.time - b.time || (a.path < b.path ? -1 : 1))
    .map((one) => ({
      path: one.path,
      east: (one.longitude - longitude) * METRES_PER_DEGREE * shrink,
      north: (one.latitude - latitude) * METRES_PER_DEGREE,
    }));
}

/** 1, 2 or 5 times a power of ten, metres: the longest bar that is no longer than a quarter of the plan. */
export function scaleBarM(extentM: number): number {
  const longest = Math.max(extentM, 1) / 4;
  const power = 10 ** Math.floor(Math.log10(longest));
  return power * ([5, 2].find((step) => step * power <= longest) ?? 1);
}

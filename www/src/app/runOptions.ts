/** What a person asks for beyond the files, as text in fields and as the core takes it. */
import type { Inspection, LoadOptions } from "../shared/results";
import type { RunOptions } from "./state";

/** The core's options; the views are named only where some are left out. */
export function loadOptions(wanted: RunOptions, inspection: Inspection | null): LoadOptions {
  const { orientation, leftOut, roi, groundZ, applyFix } = wanted;
  const used = (inspection?.images ?? []).filter(({ path }) => !leftOut.includes(path));
  return {
    ...(orientation !== null && { orientation }),
    ...(leftOut.length > 0 && { views: used.map(({ name }) => name) }),
    ...(roi !== null && { roi }),
    ...(groundZ !== null && { groundZ }),
    ...(applyFix && { applyFix }),
  };
}

export type Parsed<T> = { value: T | null } | { error: string };

/** "x0, y0, x1, y1" in metres; nothing is the whole scene. */
export function parseRegion(text: string): Parsed<[number, number, number, number]> {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  if (words.length === 0) {
    return { value: null };
  }
  const [x0, y0, x1, y1] = words.map(Number) as [number, number, number, number];
  if (words.length !== 4 || ![x0, y0, x1, y1].every(Number.isFinite)) {
    return { error: "four numbers: x0, y0, x1, y1" };
  }
  return x0 < x1 && y0 < y1 ? { value: [x0, y0, x1, y1] } : { error: "x0 < x1 and y0 < y1 are needed" };
}

/** A height in metres; nothing has it estimated. */
export function parseHeight(text: string): Parsed<number> {
  const trimmed = text.trim();
  if (trimmed === "") {
    return { value: null };
  }
  return Number.isFinite(Number(trimmed)) ? { value: Number(trimmed) } : { error: "a number in metres" };
}

/** The colours of 3D lines, and of what is faint, in legends. */
import type { LegendEntry } from "../../app/parts/Legend";
import type { LineOrigin } from "../../shared/records";
import { CERTAIN } from "../../viewer/scene/certainty";
import type { Results } from "../list";

type Lines = Pick<Results, "records">;

const LINE_ENTRIES: readonly (readonly [LineOrigin, string, string])[] = [
  ["matched", "matched", "matched"],
  ["clustered", "grown", "from regions"],
  ["intersection", "border-intersection", "intersection"],
  ["border", "border-inplane", "border"],
];

/** The kinds of 3D lines that there are. */
export function lineEntries(lines: Lines): LegendEntry[] {
  if (lines.records.length === 0) {
    return [["matched", "matched"]];
  }
  const origins = new Set(standingLines(lines).map(({ origin }) => origin));
  return LINE_ENTRIES.filter(([origin]) => origins.has(origin)).map(([, ...entry]) => entry);
}

export function hasContradicted({ records }: Lines): boolean {
  return records.some(({ contradiction }) => contradiction != null);
}

export function contradictedEntry(lines: Lines): LegendEntry[] {
  return hasContradicted(lines) ? [["rejected", "contradicted"]] : [];
}

/** Lines that are drawn as certain as they are. */
export function standingLines({ records }: Lines) {
  return records.filter(({ contradiction }) => contradiction == null);
}

/** Only where something is faint. */
export function faintEntry(things: readonly { probability?: number }[] | null): LegendEntry[] {
  const isUncertain = ({ probability = 1 }: { probability?: number }) => probability < CERTAIN;
  return things?.some(isUncertain) === true ? [["faint", "faint: less certain"]] : [];
}

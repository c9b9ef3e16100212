/** The plan of a flight: asked of the core from the headers of the photographs, before any of them is decoded. */
import { CORE_VERSION } from "../../core/engine";
import type { LoadOptions } from "../../shared/records";
import {
  flightPlan,
  measuredHeights,
  type Region,
  setDoneTiles,
  setMeasuredHeights,
  showFlightPlan,
} from "../project/tiles/flight";
import { KeptTiles } from "../project/tiles/keptTiles";
import { loadOptions } from "../settings/loadOptions";
import { params } from "../state/parameters";
import { files, inspection, type RunOptions, replaceRunOptions, runOptions } from "../state/project";
import type { Turn } from "./actionQueue";
import { engine } from "./session";

/** So many photographs are loaded at once; of more a plan is shown first. A region never takes more. */
const MOST_AT_ONCE = 12;
/** Size of the tiles of a flight where nobody states one, metres. Assumption: a few houses. */
const TILE_M = 60;

/** Where there are many photographs, tiles are asked for, unless the person wants all at once. */
export function proposeTiles(): void {
  const { tileM, isAtOnce } = runOptions.value;
  if (tileM === null && !isAtOnce && (inspection.value?.views ?? 0) > MOST_AT_ONCE) {
    replaceRunOptions({ ...runOptions.value, tileM: TILE_M });
  }
}

/** Plans the tiles, and measures the ground where nobody states its height; the plan is shown before that. */
export async function planFlight(turn: Turn, tileM: number): Promise<void> {
  await plan(tileM);
  if (runOptions.value.groundZ === null && measuredHeights.value === null) {
    turn.enter("load", "Measuring the height of the ground");
    // In the middle of the flight, whatever the region: the tiles are those of the command line.
    const found = await engine.call("groundHeights", optionsOf({ ...runOptions.value, roi: null }));
    if (found !== null) {
      setMeasuredHeights(found);
      await plan(tileM);
    }
  }
  setDoneTiles(await keptTilesOf(tileM).tiles());
}

async function plan(tileM: number): Promise<void> {
  showFlightPlan(await engine.call("planFlight", tileOptions(), tileM, measuredHeights.value));
}

/** Is a cell left out for want of memory, and not because too few photographs show it? */
export function isOfMemory(leftOut: string): boolean {
  return / MB of memory/.test(leftOut);
}

/** The options with which the tiles are planned and worked off. */
export function tileOptions(): LoadOptions {
  return optionsOf(runOptions.value);
}

/** Lowest and highest ground of the plan, by which its tiles are chosen where no region is stated. */
export function plannedHeights(): [number, number] {
  return flightPlan.value?.overview.heights ?? [0, 0];
}

/** The region of interest, or what three photographs show. */
export function plannedRegion(): Region | null {
  return runOptions.value.roi ?? flightPlan.value?.overview.shown ?? null;
}

function optionsOf(wanted: RunOptions): LoadOptions {
  return loadOptions(wanted, inspection.value);
}

/** The outcomes that are kept of these tiles, by all that they depend on. */
export function keptTilesOf(tileM: number): KeptTiles {
  const changed = (blob: Blob) => (blob instanceof File ? blob.lastModified : 0);
  const photographs = files.value.map(({ path, blob }) => [path, blob.size, changed(blob)]);
  const made = [CORE_VERSION, tileM, tileOptions(), plannedHeights(), params.value, photographs];
  return new KeptTiles(JSON.stringify(made));
}

/** Forgets the plan: the files are others. */
export function forgetFlight(): void {
  showFlightPlan(null);
  setMeasuredHeights(null);
  setDoneTiles(new Set());
}

/** The plan of a flight: asked of the core from the headers of the photographs, before any of them is decoded. */
import { CORE_VERSION } from "../../core/engine";
import type { FlightPlan, LoadOptions } from "../../shared/records";
import {
  flightPlan,
  measuredHeights,
  plannedReduction,
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
/** A tile may take so much, megabytes: what a page on a machine of 8 GB has to spare. */
const BUDGET_MB = 1200;
/** How much smaller photographs are made until a tile fits. */
const REDUCTIONS = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16];

/** Where there are many photographs, tiles are asked for, unless the person wants all at once. */
export function proposeTiles(): void {
  const { tileM, isAtOnce } = runOptions.value;
  if (tileM === null && !isAtOnce && (inspection.value?.views ?? 0) > MOST_AT_ONCE) {
    replaceRunOptions({ ...runOptions.value, tileM: TILE_M });
  }
}

/** Plans the tiles, and measures the ground where nobody states its height; the plan is shown before that. */
export async function planFlight(turn: Turn, tileM: number): Promise<void> {
  await planFitting(tileM);
  if (runOptions.value.groundZ === null && measuredHeights.value === null) {
    turn.enter("load", "Measuring the height of the ground");
    // In the middle of the flight, whatever the region: the tiles are those of the command line.
    const found = await engine.call("groundHeights", optionsOf({ ...runOptions.value, roi: null }));
    if (found !== null) {
      setMeasuredHeights(found);
      await planFitting(tileM);
    }
  }
  setDoneTiles(await keptTilesOf(tileM).tiles());
}

/** With the size that was asked for, or the largest of those that roofs need that the memory takes. */
async function planFitting(tileM: number): Promise<void> {
  const planned = (reduction: number) =>
    engine.call("planFlight", optionsOf({ ...runOptions.value, reduction }), tileM, measuredHeights.value);
  const asked = runOptions.value.reduction;
  let reduction = asked ?? 1;
  let plan = await planned(reduction);
  if (asked === null) {
    const enough = plan.overview.reduction;
    for (const next of [enough, ...REDUCTIONS.filter((factor) => factor > enough)]) {
      if (next > reduction) {
        reduction = next;
        plan = await planned(reduction);
      }
      if (fits(plan)) {
        break;
      }
    }
  }
  showFlightPlan(plan, reduction);
}

function fits({ tiles }: FlightPlan): boolean {
  return tiles.every(({ memory_mb, left_out }) => memory_mb <= BUDGET_MB && !isOfMemory(left_out));
}

/** Is a tile left out for want of memory, and not because too few photographs show it? */
export function isOfMemory(leftOut: string | null): boolean {
  return leftOut !== null && / MB of memory/.test(leftOut);
}

/** The options with which the tiles are worked off: the size of the photographs is that of the plan. */
export function tileOptions(): LoadOptions {
  return optionsOf({ ...runOptions.value, reduction: plannedReduction.value });
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

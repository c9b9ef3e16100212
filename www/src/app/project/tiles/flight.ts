/** A flight that is worked off in tiles: its plan, and how far its tiles are. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { FlightPlan } from "../../../shared/records";
import { secondsPerMegapixel } from "./pace";

export type Region = readonly [x0: number, y0: number, x1: number, y1: number];

/** A run over the tiles that is going on. */
interface TileRun {
  /** Which tile, and the fraction of it that is done. */
  tile: number;
  fraction: number;
  /** When it was begun, milliseconds of `performance.now()`. */
  since: number;
  /** So many seconds are left for all. */
  secondsLeft: number;
}

const present = {
  plan: signal<FlightPlan | null>(null),
  measured: signal<[number, number] | null>(null),
  reduction: signal(1),
  done: signal<ReadonlyMap<number, string | null>>(new Map()),
  run: signal<TileRun | null>(null),
};

/** The plan as it was asked for last; null where there is none. */
export const flightPlan: ReadonlySignal<FlightPlan | null> = present.plan;
/** Lowest and highest ground as photographs show it, metres; null until it was measured. */
export const measuredHeights: ReadonlySignal<[number, number] | null> = present.measured;
/** So many by so many pixels of a photograph are one of the plan's. */
export const plannedReduction: ReadonlySignal<number> = present.reduction;
/** The tiles whose outcome is kept, each with its words; null until it was read. */
export const doneTiles: ReadonlySignal<ReadonlyMap<number, string | null>> = present.done;
export const tileRun: ReadonlySignal<TileRun | null> = present.run;

/** The tiles that show something, by their number from 0. */
export const usedTiles = computed(() =>
  (flightPlan.value?.tiles ?? []).flatMap(({ left_out }, i) => (left_out === null ? [i] : [])),
);

/** How many photographs the tiles read, and how many of them those that are done have read. */
export const photographsRead = computed(() => {
  const tiles = flightPlan.value?.tiles ?? [];
  const read = (of: readonly number[]) =>
    new Set(of.flatMap((i) => (tiles[i]?.views ?? []).map(({ view }) => view))).size;
  const begun = tileRun.value === null ? [] : [tileRun.value.tile];
  return { done: read([...doneTiles.value.keys(), ...begun]), all: read(usedTiles.value) };
});

export function showFlightPlan(plan: FlightPlan | null, reduction = 1): void {
  present.plan.value = plan;
  present.reduction.value = reduction;
}

export function setMeasuredHeights(heights: [number, number] | null): void {
  present.measured.value = heights;
}

export function setDoneTiles(done: ReadonlySet<number>): void {
  present.done.value = new Map([...done].map((tile) => [tile, null]));
}

export function addDoneTile(tile: number, outcome: string): void {
  present.done.value = new Map([...present.done.peek(), [tile, outcome]]);
}

export function showTileRun(run: TileRun | null): void {
  present.run.value = run;
}

/** How far the present tile is, from the progress of all of them; from a tenth on it tells how long the others take. */
export function showTileFraction(ofAll: number): void {
  const run = present.run.peek();
  const plan = present.plan.peek();
  if (run === null || plan === null) {
    return;
  }
  const within = Math.min(Math.max(ofAll * plan.tiles.length - run.tile, 0), 1);
  const fraction = Math.max(run.fraction, within);
  const own = megapixelsOf(plan, run.tile);
  const isTelling = fraction > 0.1 && own > 0;
  const pace = isTelling
    ? (performance.now() - run.since) / 1000 / (fraction * own)
    : secondsPerMegapixel.peek();
  present.run.value = { ...run, fraction, secondsLeft: pace * (megapixelsLeft() - fraction * own) };
}

/** Megapixels of the tiles that are not done. */
export function megapixelsLeft(): number {
  const plan = present.plan.peek();
  const left = usedTiles.peek().filter((tile) => !present.done.peek().has(tile));
  return left.reduce((sum, tile) => sum + (plan === null ? 0 : megapixelsOf(plan, tile)), 0);
}

/** Megapixels that a tile reads. */
export function megapixelsOf(plan: FlightPlan, tile: number): number {
  const views = plan.tiles[tile]?.views ?? [];
  return views.reduce((sum, { window: [, , width, height] }) => sum + (width * height) / 1e6, 0);
}

/** A flight that is worked off in tiles: its plan, and how far its tiles are. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { FlightPlan } from "../../shared/records";

export type Region = readonly [x0: number, y0: number, x1: number, y1: number];

/** What became of a tile so far. */
export type TileStatus = "waiting" | "running" | "done";

/** A run over the tiles that is going on. */
export interface TileRun {
  /** Which tile, and the fraction of it that is done. */
  tile: number;
  fraction: number;
  /** So many seconds are left, as far as the tiles that are done tell; null before there is one. */
  secondsLeft: number | null;
}

const present = {
  plan: signal<FlightPlan | null>(null),
  measured: signal<[number, number] | null>(null),
  reduction: signal(1),
  done: signal<ReadonlySet<number>>(new Set()),
  run: signal<TileRun | null>(null),
};

/** The plan as it was asked for last; null where there is none. */
export const flightPlan: ReadonlySignal<FlightPlan | null> = present.plan;
/** Lowest and highest ground as photographs show it, metres; null until it was measured. */
export const measuredHeights: ReadonlySignal<[number, number] | null> = present.measured;
/** So many by so many pixels of a photograph are one of the plan's. */
export const plannedReduction: ReadonlySignal<number> = present.reduction;
/** The tiles whose outcome is kept. */
export const doneTiles: ReadonlySignal<ReadonlySet<number>> = present.done;
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
  return { done: read([...doneTiles.value, ...begun]), all: read(usedTiles.value) };
});

export function showFlightPlan(plan: FlightPlan | null, reduction = 1): void {
  present.plan.value = plan;
  present.reduction.value = reduction;
}

export function setMeasuredHeights(heights: [number, number] | null): void {
  present.measured.value = heights;
}

export function setDoneTiles(done: ReadonlySet<number>): void {
  present.done.value = done;
}

export function showTileRun(run: TileRun | null): void {
  present.run.value = run;
}

/** How far the present tile is, from the progress of all of them. */
export function showTileFraction(ofAll: number): void {
  const run = present.run.peek();
  const count = present.plan.peek()?.tiles.length ?? 0;
  if (run !== null) {
    const within = Math.min(Math.max(ofAll * count - run.tile, 0), 1);
    present.run.value = { ...run, fraction: Math.max(run.fraction, within) };
  }
}

/** Megapixels that a tile reads. */
export function megapixelsOf(plan: FlightPlan, tile: number): number {
  const views = plan.tiles[tile]?.views ?? [];
  return views.reduce((sum, { window: [, , width, height] }) => sum + (width * height) / 1e6, 0);
}

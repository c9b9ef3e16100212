/** A flight that is worked off in tiles: its plan, and how far its tiles are. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { FlightPlan, WorkPlan } from "../../../shared/records";
import { secondsPerMegapixel } from "./pace";

export type Region = readonly [x0: number, y0: number, x1: number, y1: number];

/** A run over the tiles that is going on. */
interface TileRun {
  /** Which tile, null during the first look; how many were worked off before it, and the fraction of it that is done. */
  tile: number | null;
  before: number;
  fraction: number;
  /** When it was begun, milliseconds of `performance.now()`. */
  since: number;
  /** So many seconds are left for all. */
  secondsLeft: number;
}

const present = {
  plan: signal<FlightPlan | null>(null),
  measured: signal<[number, number] | null>(null),
  work: signal<WorkPlan | null>(null),
  done: signal<ReadonlyMap<number, string | null>>(new Map()),
  run: signal<TileRun | null>(null),
};

/** The plan as it was asked for last; null where there is none. */
export const flightPlan: ReadonlySignal<FlightPlan | null> = present.plan;
/** Lowest and highest ground as photographs show it, metres; null until it was measured. */
export const measuredHeights: ReadonlySignal<[number, number] | null> = present.measured;
/** What the tiles read, and their order; null before the first look. */
export const workPlan: ReadonlySignal<WorkPlan | null> = present.work;
/** So many by so many pixels of a photograph are one of the plan's. */
export const plannedReduction = computed(
  () => present.work.value?.reduction ?? present.plan.value?.overview.reduction ?? 1,
);
/** The tiles whose outcome is kept, each with its words; null until it was read. */
export const doneTiles: ReadonlySignal<ReadonlyMap<number, string | null>> = present.done;
export const tileRun: ReadonlySignal<TileRun | null> = present.run;

/** The tiles that are worked off, by their number from 0: not those of which every cell is left out. */
export const usedTiles = computed(() =>
  [...(flightPlan.value?.tiles ?? []).keys()].filter((tile) => {
    const cells = cellsOf(tile);
    return cells.length === 0 || cells.some(({ left_out }) => left_out === undefined);
  }),
);

/** How many photographs the tiles read, and how many of them those that are done have read. */
export const photographsRead = computed(() => {
  const read = (of: readonly number[]) => new Set(of.flatMap(viewsOf)).size;
  const running = tileRun.value?.tile ?? null;
  const begun = running === null ? [] : [running];
  return { done: read([...doneTiles.value.keys(), ...begun]), all: read(usedTiles.value) };
});

export function showFlightPlan(plan: FlightPlan | null): void {
  present.plan.value = plan;
  present.work.value = null;
}

export function showWorkPlan(work: WorkPlan): void {
  present.work.value = work;
}

/** What a tile works on, as far as it is known. */
export function cellsOf(tile: number): WorkPlan["tiles"][number]["cells"] {
  return workPlan.value?.tiles[tile]?.cells ?? [];
}

/** The photographs that a tile reads. */
export function viewsOf(tile: number): string[] {
  return [...new Set(cellsOf(tile).flatMap(({ views }) => views.map(({ view }) => view)))];
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
  const within = Math.min(Math.max(ofAll * plan.tiles.length - run.before, 0), 1);
  const fraction = Math.max(run.fraction, within);
  const own = run.tile === null ? 0 : megapixelsOf(run.tile);
  const isTelling = fraction > 0.1 && own > 0;
  const pace = isTelling
    ? (performance.now() - run.since) / 1000 / (fraction * own)
    : secondsPerMegapixel.peek();
  present.run.value = { ...run, fraction, secondsLeft: pace * (megapixelsLeft() - fraction * own) };
}

/** Megapixels of the tiles that are not done. */
export function megapixelsLeft(): number {
  const left = usedTiles.peek().filter((tile) => !present.done.peek().has(tile));
  return left.reduce((sum, tile) => sum + megapixelsOf(tile), 0);
}

/** Megapixels that a tile reads. */
export function megapixelsOf(tile: number): number {
  const views = cellsOf(tile).flatMap(({ views }) => views);
  return views.reduce((sum, { window: [, , width, height] }) => sum + (width * height) / 1e6, 0);
}

/**
 * A flight, tile by tile in the worker, and one model of all of them. Each outcome is kept in the browser as soon as it is
 * there, and its model shown: a run that was cancelled, or ended with the page, goes on with the next tile.
 */
import { batch } from "@preact/signals";
import { EngineError } from "../../core/engine";
import type { TileOutcome } from "../../shared/calls";
import type { TileReport, WorkPlan } from "../../shared/records";
import { counted } from "../parts/counted";
import {
  addDoneTile,
  cellsOf,
  flightPlan,
  megapixelsLeft,
  megapixelsOf,
  showTileRun,
  showWorkPlan,
} from "../project/tiles/flight";
import type { KeptTiles } from "../project/tiles/keptTiles";
import { noteTile, secondsPerMegapixel } from "../project/tiles/pace";
import { announce } from "../state/notices";
import { params } from "../state/parameters";
import { addTileModel, NO_RESULTS, setExportNames, setResults } from "../state/results";
import { updateStage } from "../state/stages";
import { showTab, tab } from "../state/viewState";
import type { Turn } from "./actionQueue";
import { keptTilesOf, planFlight, plannedHeights, tileOptions } from "./flightPlanning";
import { engine, ensureInspected, noteResults, outdateScene, tellParams } from "./session";

/** The progress of the whole area is shown at the last stage: only the model spans the tiles. */
const STAGE = "model";

/** Works off the region of interest in tiles of about this size, metres. */
export async function runTiles(turn: Turn, tileM: number): Promise<void> {
  await ensureInspected();
  await planFlight(turn, tileM);
  turn.enter("run");
  await tellParams(params.value);
  const started = performance.now();
  // The worker drops the scene: a tile needs the memory.
  outdateScene();
  batch(() => {
    setResults(NO_RESULTS);
    setExportNames([]);
    updateStage(STAGE, { status: "running", fraction: 0, warnings: [], counts: {} });
  });
  try {
    const reports = await runEach(turn, keptTilesOf(tileM), tileM);
    await engine.call("joinTiles");
    noteResults();
    const glb = await engine.call("exportFile", "model.glb");
    const names = await engine.call("exportNames");
    batch(() => {
      setResults({ ...NO_RESULTS, glb });
      setExportNames(names);
      showTab(STAGE);
      updateStage(STAGE, {
        status: "done",
        fraction: 1,
        seconds: (performance.now() - started) / 1000,
        counts: { tiles: reports.length },
        warnings: reports.filter(({ is_left_out }) => is_left_out).map(({ outcome }) => outcome),
      });
    });
    announce(`${counted(reports.length, "tiles")} done and joined`);
  } catch (error) {
    const cancelled = error instanceof EngineError && error.kind === "cancelled";
    updateStage(STAGE, { status: cancelled ? "waiting" : "failed", fraction: 0 });
    if (error instanceof EngineError) {
      error.during = "the tiles";
    }
    throw error;
  } finally {
    showTileRun(null);
  }
}

async function runEach(turn: Turn, kept: KeptTiles, tileM: number): Promise<TileReport[]> {
  await engine.call("planTiles", tileOptions(), tileM, plannedHeights());
  const { order } = await lookFirst(turn, kept);
  const reports: TileReport[] = [];
  for (const [before, tile] of order.entries()) {
    const secondsLeft = secondsPerMegapixel.value * megapixelsLeft();
    showTileRun({ tile, before, fraction: 0, since: performance.now(), secondsLeft });
    turn.enter("run", `Tile ${before + 1} of ${order.length}`);
    announce(`Tile ${before + 1} of ${order.length}`);
    const { report, glb } =
      (await keptOutcome(kept, tile)) ?? (await workOff(kept, tile, before, order.length));
    reports[tile] = report;
    addDoneTile(tile, report.outcome);
    if (glb !== null) {
      addTileModel(glb);
      // The model is to be seen growing, unless something else is looked at.
      if (tab.value === "images") {
        showTab(STAGE);
      }
    }
  }
  turn.enter("run", "Joining the tiles");
  for (const tile of reports.keys()) {
    const outcome = await kept.read(tile);
    if (outcome === null) {
      throw new Error("A tile that was done cannot be read any more. Run again: it is computed anew.");
    }
    await engine.callMoving([outcome.buffer], "takeTile", outcome);
  }
  return reports;
}

/** Looks at the whole area in small photographs: what the tiles then read, where a roof may be. */
async function lookFirst(turn: Turn, kept: KeptTiles): Promise<WorkPlan> {
  const squares = await engine.call("squaresToLookAt");
  turn.enter("run", "Looking for places where a roof may be");
  showTileRun({ tile: null, before: 0, fraction: 0, since: performance.now(), secondsLeft: 0 });
  const tiles = flightPlan.value?.tiles.length ?? 1;
  for (let index = 0; index < squares; index++) {
    const key = -1 - index;
    let seen = await kept.read(key);
    if (seen === null) {
      // Together the squares count as much as the first tile.
      seen = await engine.call("lookAt", STAGE, index, squares * tiles);
      await kept.keep(key, seen);
    }
    await engine.callMoving([seen.buffer], "takeLook", seen);
  }
  const work = await engine.call("workPlan");
  showWorkPlan(work);
  return work;
}

/** What is kept of a tile; null where nothing is, or what another core would not take. */
async function keptOutcome(kept: KeptTiles, index: number): Promise<TileOutcome | null> {
  const outcome = await kept.read(index);
  if (outcome === null) {
    return null;
  }
  try {
    return await engine.callMoving([outcome.buffer], "tileModel", index, outcome);
  } catch (error) {
    if (error instanceof EngineError && error.kind === "input") {
      await kept.forget(index);
      return null;
    }
    throw error;
  }
}

async function workOff(kept: KeptTiles, tile: number, before: number, of: number): Promise<TileOutcome> {
  const started = performance.now();
  const outcome = await engine.call("runTile", STAGE, tile, cellsOf(tile).length, before, of);
  noteTile((performance.now() - started) / 1000, megapixelsOf(tile));
  await kept.keep(tile, outcome);
  return engine.callMoving([outcome.buffer], "tileModel", tile, outcome);
}

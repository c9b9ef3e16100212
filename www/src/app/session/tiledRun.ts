/** A large area, tile by tile in the worker, and one model of all of them. */
import { batch } from "@preact/signals";
import { EngineError } from "../../core/engine";
import type { TileReport } from "../../shared/records";
import { counted } from "../parts/counted";
import { loadOptions } from "../settings/loadOptions";
import { announce } from "../state/notices";
import { params } from "../state/parameters";
import { inspection, runOptions } from "../state/project";
import { NO_RESULTS, setExportNames, setResults } from "../state/results";
import { updateStage } from "../state/stages";
import { showTab } from "../state/viewState";
import { engine, ensureInspected, noteResults, outdateScene } from "./session";

/** The progress of the whole area is shown at the last stage: only the model spans the tiles. */
const STAGE = "model";

/** Works off the region of interest in tiles of about this size, metres. */
export async function runTiles(tileM: number): Promise<void> {
  await ensureInspected();
  await engine.call("setParams", params.value);
  const started = performance.now();
  // The worker drops the scene: a tile needs the memory.
  outdateScene();
  batch(() => {
    setResults(NO_RESULTS);
    setExportNames([]);
    updateStage(STAGE, { status: "running", fraction: 0, warnings: [], counts: {} });
  });
  try {
    const reports = await runEach(tileM);
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
        warnings: reports
          .filter(({ outcome }) => !/ buildings?$/.test(outcome))
          .map(({ outcome }) => outcome),
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
  }
}

async function runEach(tileM: number): Promise<TileReport[]> {
  const options = loadOptions(runOptions.value, inspection.value);
  const tiles = await engine.call("planTiles", options, tileM);
  const reports: TileReport[] = [];
  for (const index of tiles.keys()) {
    announce(`Tile ${index + 1} of ${tiles.length}`);
    const report = await engine.call("runTile", STAGE, index, tiles.length);
    if (report !== null) {
      reports.push(report);
    }
  }
  return reports;
}

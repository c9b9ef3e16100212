/** A first look at a scene: a preliminary model, found on smaller photographs beside the first stages of the run. */
import { announce } from "../state/notices";
import { params } from "../state/parameters";
import { mainResults, showPreliminary } from "../state/results";
import { leadTo } from "../state/viewState";
import { workers } from "../state/workers";
import { engine, workerPool } from "./session";

/** The run whose first look is awaited; none once it has ended. */
let awaiting: object | null = null;

/** Begins the first look, where the core says that it is worth while. Its model is shown until the run has its own. */
export async function beginFirstLook(): Promise<void> {
  if (mainResults.value.facets !== null) {
    return;
  }
  const packed = await engine.call("packPreliminary");
  if (packed.length > 0) {
    awaiting = {};
    void look(packed, awaiting);
  }
}

/** The run has ended: there is its own model, or none. */
export function endFirstLook(): void {
  awaiting = null;
  showPreliminary(null);
}

async function look(packed: Uint8Array<ArrayBuffer>, run: object): Promise<void> {
  const facets = await workerPool.firstLook(packed, params.value, workers.value);
  const isInTime = awaiting === run && mainResults.value.facets === null;
  if (facets !== null && facets.length > 0 && isInTime) {
    showPreliminary(facets);
    leadTo("model");
    announce("A preliminary model is shown");
  }
}

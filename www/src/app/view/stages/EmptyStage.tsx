/** What stands in the image tabs as long as there are no images. */

import { counted } from "../../parts/counted";
import { FlightPlanView } from "../../project/flight/FlightPlanView";
import { PhotographsOnly } from "../../project/photographs/PhotographsOnly";
import { openDemo } from "../../project/projectActions";
import { flightPlan } from "../../project/tiles/flight";
import { isBusy } from "../../state/activity";
import { files, inspection } from "../../state/project";
import { startTour } from "../../tour/steps";

export function EmptyStage() {
  const photographs = inspection.value?.images ?? [];
  if (photographs.length > 0 && photographs.every(({ orientation }) => orientation === null)) {
    return <PhotographsOnly />;
  }
  if (flightPlan.value !== null) {
    return <FlightPlanView />;
  }
  if (isBusy.value && files.value.length > 0) {
    return (
      <div class="empty">
        <p>Reading {counted(files.value.length, "files")}…</p>
      </div>
    );
  }
  return (
    <div class="empty">
      <p>Nothing to reconstruct yet.</p>
      <p class="muted">
        Add three or more photographs, with their orientation or without, or begin with the example.
      </p>
      <p class="row">
        <button type="button" class="primary" onClick={() => void openDemo()}>
          Reconstruct the example
        </button>
        <button type="button" onClick={startTour}>
          Take the tour
        </button>
      </p>
    </div>
  );
}

/** What stands in the image tabs as long as there are no images. */
import { FlightPlanView } from "../../project/flight/FlightPlanView";
import { PhotographsOnly } from "../../project/photographs/PhotographsOnly";
import { openDemo } from "../../project/projectActions";
import { flightPlan } from "../../project/tiles/flight";
import { inspection } from "../../state/project";
import { startTour } from "../../tour/steps";

export function EmptyStage() {
  const photographs = inspection.value?.images ?? [];
  if (photographs.length > 0 && photographs.every(({ orientation }) => orientation === null)) {
    return <PhotographsOnly />;
  }
  if (flightPlan.value !== null) {
    return <FlightPlanView />;
  }
  return (
    <div class="empty">
      <p>No oriented views yet.</p>
      <p class="muted">Add photographs with their orientation to the project, or begin with the example.</p>
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

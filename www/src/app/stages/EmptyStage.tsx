/** What stands in the image tabs as long as there are no images. */
import { openDemo } from "../project/projectActions";
import { startTour } from "../tour/lessons";

export function EmptyStage() {
  return (
    <div class="empty">
      <p>No oriented views yet.</p>
      <p class="muted">
        Add photographs with their orientation on the left, or begin with six aerial views of detached houses.
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

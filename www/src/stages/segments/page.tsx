/** The switch for what was rejected, above the photographs. */
import { showRejected, withRejected } from "../../app/state/viewState";
import type { StagePage } from "../stagePage";

function RejectedSwitch() {
  return (
    <button
      type="button"
      aria-pressed={withRejected.value}
      class="toggle"
      onClick={() => {
        showRejected(!withRejected.value);
      }}
    >
      Rejected lines
    </button>
  );
}

export default { Switch: RejectedSwitch } satisfies StagePage;

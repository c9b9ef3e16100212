/** The 3D lines in space, with their uncertainty, and as they were before growing. */
import { Choice } from "../../app/parts/Choice";
import { results } from "../../app/state/results";
import { beforeGrowing, showBeforeGrowing, tab } from "../../app/state/viewState";
import { linesOf } from "../../kinds/kinds";
import { LINE_STRIDE } from "../../shared/flatArrays";
import type { LineRecord } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { ENDS } from "../sample";
import { planOf, type StagePage } from "../stagePage";
import { buildLines } from "./linesLayer";
import { buildStretches } from "./stretchesLayer";
import { buildUncertainty, enlargement } from "./uncertaintyLayer";

/** The 3D lines of a selection, in the results of now. */
const ownLines = (picked: Selection | null) => linesOf(picked, results.peek());

const isBeforeGrowing = () => tab.value === "lines" && beforeGrowing.value;

const NO_COVARIANCE: LineRecord["covariance"][number] = [0, 0, 0, 0, 0, 0];
const SEEN: LineRecord = {
  origin: "matched",
  contradiction: null,
  probability: 1,
  by_views: null,
  in_model: null,
  sigma_m: 0,
  covariance: [NO_COVARIANCE, NO_COVARIANCE],
  supports: [],
};

export default {
  layers: {
    lines: {
      title: "3D lines",
      plan: planOf(({ lines, records }) => [lines, records, ownLines], buildLines),
      isSeen: (isChosen) => isChosen && !isBeforeGrowing(),
      pickOrder: 3,
      isMeasured: true,
      // A line that no view shows has a shader of its own, for its dashes.
      warm: () => buildLines(ENDS, [SEEN, { ...SEEN, origin: "intersection" }], () => []),
    },
    uncertainty: {
      title: "Uncertainty",
      // Thousands of tubes that few look at.
      plan: ({ isChosen }) => {
        const { lines, records } = results.value;
        const has = isChosen && lines !== null && records.length * LINE_STRIDE === lines.length;
        return has ? [() => buildUncertainty(lines, records, enlargement(records), ownLines), records] : null;
      },
      pickOrder: 4,
      Legend: UncertaintyLegend,
    },
    stretches: {
      plan: planOf(({ stretches }) => [stretches], buildStretches),
      isSeen: isBeforeGrowing,
      pickOrder: 2,
      isMeasured: true,
    },
  },
  shows: ["lines"],
  isEmpty: ({ lines }) => lines === null,
  Switch: GrowingSwitch,
} satisfies StagePage;

/** B99 figures 5 and 7 against 6 and 8. */
function GrowingSwitch() {
  return (
    <Choice
      legend="Before or after growing"
      choices={[
        [true, "Before growing"],
        [false, "After"],
      ]}
      chosen={beforeGrowing.value}
      choose={showBeforeGrowing}
      class="growing"
    />
  );
}

function UncertaintyLegend() {
  const { records } = results.value;
  return records.length === 0 ? null : (
    <p class="legend">
      <span class="swatch merged" aria-hidden="true" />1 σ, drawn {enlargement(records)} × as large
    </p>
  );
}

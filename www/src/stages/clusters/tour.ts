/** The tour: the other way, in object space. */
import { counted } from "../../app/parts/counted";
import { results } from "../../app/state/results";
import { selection, showView, tab } from "../../app/state/viewState";
import { pickedIndex } from "../../shared/selection";
import { ALL_VIEWS } from "../figure";
import type { StageStep } from "../tourStep";

export default [
  {
    title: "Another way: object space",
    text: "Wiman and Axelsson match nothing between images. Each image line of a main direction is a line in the plane across it; where lines of several views meet, there is an edge in space.",
    question: "Pick a ring in the cluster plane, and see its line in every view.",
    answer: () =>
      `Boundaries of regions in ${counted(pickedViews(), "views")} meet there. Nothing was compared pixel by pixel: geometry and description length alone chose the line.`,
    hint: () => (selection.value?.kind === "cluster" ? "This one was rejected: pick a large ring." : null),
    prepare: () => {
      showView(ALL_VIEWS);
    },
    isFound: () => selection.value?.kind === "line" && tab.value === "clusters",
  },
] satisfies readonly StageStep[];

/** In how many views the picked line shows. */
function pickedViews(): number {
  return results.value.records[pickedIndex(selection.value, "line")]?.supports.length ?? 0;
}

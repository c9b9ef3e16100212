/** What the colours of the present tab mean. */
import { Legend, type LegendEntry } from "../app/parts/Legend";
import { results } from "../app/state/results";
import { beforeGrowing, tab, withRejected } from "../app/state/viewState";
import { FIGURES } from "./figures";

export function presentEntries(): readonly LegendEntry[] {
  return (
    FIGURES[tab.value].legend?.({
      results: results.value,
      beforeGrowing: beforeGrowing.value,
      withRejected: withRejected.value,
    }) ?? []
  );
}

export function PageLegend() {
  return <Legend entries={presentEntries()} />;
}

/** Says how many roof planes have no facet in the model, and leads to them one after the other. */

import { computed } from "@preact/signals";
import { counted } from "../../parts/counted";
import { results } from "../../state/results";
import { select, selection, showTab } from "../../state/viewState";
import { unmodelledPlanes } from "./unmodelledPlanes";

const missing = computed(() => {
  const { verification, facets } = results.value;
  return verification === null || facets === null ? [] : unmodelledPlanes(verification.rejected, facets);
});

export function Unmodelled() {
  const planes = missing.value;
  if (planes.length === 0) {
    return null;
  }
  const showNext = () => {
    const picked = selection.peek();
    const shown = picked?.kind === "rejectedFacet" ? planes.indexOf(picked.index) : -1;
    showTab("facets");
    select({ kind: "rejectedFacet", index: planes[(shown + 1) % planes.length] as number });
  };
  return (
    <button type="button" class="unmodelled" onClick={showNext}>
      {counted(planes.length, "roof planes")} found, but not in the model: show
    </button>
  );
}

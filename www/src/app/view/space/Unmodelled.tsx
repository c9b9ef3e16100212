/** Says at how many places a roof may be and the model has none, and leads to them one after the other. */

import { counted } from "../../parts/counted";
import { results } from "../../state/results";
import { select, selection } from "../../state/viewState";

export function Unmodelled() {
  const places = results.value.uncovered?.length ?? 0;
  if (places === 0) {
    return null;
  }
  const showNext = () => {
    const picked = selection.peek();
    const shown = picked?.kind === "uncoveredRoof" ? picked.index : -1;
    select({ kind: "uncoveredRoof", index: (shown + 1) % places });
  };
  return (
    <button type="button" class="unmodelled" onClick={showNext}>
      {counted(places, "places")} may be roof, and not in the model: show
    </button>
  );
}

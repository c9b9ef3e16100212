/** Says at how many places a roof may be and the model has none, and leads to them one after the other. */
import { signal } from "@preact/signals";
import { pickedIndex } from "../../../shared/selection";
import { counted } from "../../parts/counted";
import { results } from "../../state/results";
import { aimAt, select, selection } from "../../state/viewState";

/** The list of places that the person has put aside. */
const closed = signal<unknown>(null);

export function Unmodelled() {
  const { uncovered } = results.value;
  const places = uncovered?.length ?? 0;
  if (places === 0 || closed.value === uncovered) {
    return null;
  }
  const showNext = () => {
    const shown = pickedIndex(selection.peek(), "uncoveredRoof");
    const index = (shown + 1) % places;
    select({ kind: "uncoveredRoof", index });
    aimAt(uncovered?.[index]?.outline ?? []);
  };
  return (
    <div class="unmodelled">
      <button type="button" onClick={showNext}>
        {counted(places, "places")} may be roof, and not in the model: show
      </button>
      <button type="button" aria-label="Close this note" onClick={() => (closed.value = uncovered)}>
        ✕
      </button>
    </div>
  );
}

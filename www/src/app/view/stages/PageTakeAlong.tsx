/** What can be taken along of the view that is shown. */

import { FIGURES } from "../../../stages/figures";
import { TakeAlong } from "../../results/takeAlong/TakeAlong";
import { pageFigure } from "../../selection/selectionQueries";
import { tab } from "../../state/viewState";

export function PageTakeAlong() {
  const name = tab.value;
  return (
    <section class="panel" aria-label="Take along">
      <TakeAlong
        of={FIGURES[name]}
        name={name}
        rows={() => FIGURES[name].rows(pageFigure())}
        body={shown}
        link={() => location.href}
      />
    </section>
  );
}

/** Photographs with what is below them; of a view in space the figure alone, for the space has a picture of its own. */
function shown(): HTMLElement | null {
  return (
    document.querySelector<HTMLElement>("#stage-view:has(.image-views)") ?? document.querySelector(".lab")
  );
}

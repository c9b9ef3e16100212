/** The image tabs: one view or all of them, with what the tab's stage found drawn over. */
import "./images.css";
import type { ComponentChildren } from "preact";
import type { Mark } from "../../../kinds/parts/marks";
import type { Vec2 } from "../../../shared/records";
import { ALL_VIEWS, type Figure } from "../../../stages/figure";
import { followsSelection, zoomToSelection } from "../../state/viewState";
import type { Overlay } from "./drawing";
import { FigureImage } from "./ImageRow";
import { ViewPicker } from "./ViewPicker";

/** Something that is drawn in the views by clicks. */
export interface PlaceTool {
  /** Takes a place of a view, pixels, each shown as `scale` pixels of the display; null ends the tool. Undefined: clicks pick. */
  onPlace?: ((view: number, at: Vec2 | null, scale: number) => void) | undefined;
  /** What it shows in a view. */
  marks: (view: number) => readonly Mark[];
}

interface Props {
  figure: Figure;
  overlay: (view: number, figure: Figure) => Overlay;
  /** What the tab itself switches, and what its colours mean. */
  switches: ComponentChildren;
  legend: ComponentChildren;
  /** Stands in their place as long as there are none. */
  empty: ComponentChildren;
  tool?: PlaceTool | undefined;
}

export function ImageViews({ figure, overlay, switches, legend, empty, tool }: Props) {
  const { scene, images, view: asked, act } = figure;
  const views = scene?.views ?? [];
  if (views.length === 0 || images.length === 0) {
    return <>{empty}</>;
  }
  const shown = asked === ALL_VIEWS ? views.map((_, i) => i) : [Math.min(asked, views.length - 1)];
  return (
    <div class="image-views">
      <div class="toolbar">
        <ViewPicker views={views} shown={asked} withAll show={act.showView} />
        {switches}
        {shown.length > 1 && <FollowSwitch />}
        <span class="grow" />
        {legend}
      </div>
      <div class={`image-grid ${shown.length > 1 ? "many" : ""}`}>
        {shown.map((view) => (
          <FigureImage
            key={view}
            figure={figure}
            overlay={overlay}
            view={view}
            marks={tool?.marks(view)}
            follows={followsSelection.value && shown.length > 1}
            onPlace={tool?.onPlace && ((at, scale) => tool.onPlace?.(view, at, scale))}
          />
        ))}
      </div>
    </div>
  );
}

function FollowSwitch() {
  return (
    <button
      type="button"
      aria-pressed={followsSelection.value}
      class="toggle"
      onClick={() => {
        zoomToSelection(!followsSelection.value);
      }}
    >
      Zoom to selection
    </button>
  );
}

/** The image tabs: one view or all of them, with what the tab's stage found drawn over. */
import "./images.css";
import type { ComponentChildren } from "preact";
import { marksOf } from "../../kinds/kinds";
import type { Mark } from "../../kinds/parts/marks";
import type { Figure } from "../../shared/figure";
import type { Vec2 } from "../../shared/records";
import { Legend } from "../parts/Legend";
import { followsSelection, showRejected, tab, withRejected, zoomToSelection } from "../state/viewState";
import { ImageCanvas } from "./ImageCanvas";
import { overlayOf } from "./overlays";
import { ALL_VIEWS, ViewPicker } from "./ViewPicker";

/** Something that is drawn in the views by clicks. */
export interface PlaceTool {
  /** Takes a place of a view, pixels, each shown as `scale` pixels of the display; null ends the tool. Undefined: clicks pick. */
  onPlace?: ((view: number, at: Vec2 | null, scale: number) => void) | undefined;
  /** What it shows in a view. */
  marks: (view: number) => readonly Mark[];
}

interface Props {
  figure: Figure;
  /** Stands in their place as long as there are none. */
  empty: ComponentChildren;
  tool?: PlaceTool | undefined;
}

export function ImageViews({ figure, empty, tool }: Props) {
  const { scene, images, selection, view: asked, act } = figure;
  const views = scene?.views ?? [];
  if (views.length === 0 || images.length === 0) {
    return <>{empty}</>;
  }
  const shown = asked === ALL_VIEWS ? views.map((_, i) => i) : [Math.min(asked, views.length - 1)];
  return (
    <div class="image-views">
      <div class="toolbar">
        <ViewPicker views={views} shown={asked} withAll show={act.showView} />
        {tab.value === "segments" && <RejectedSwitch />}
        {shown.length > 1 && <FollowSwitch />}
        <span class="grow" />
        <Legend />
      </div>
      <div class={`image-grid ${shown.length > 1 ? "many" : ""}`}>
        {shown.map((view) => (
          <ImageCanvas
            key={view}
            view={view}
            name={views[view]?.name ?? ""}
            image={images[view] as ImageBitmap}
            overlay={overlayOf(tab.value, view, figure, withRejected.value)}
            selection={selection}
            marks={[...marksOf(selection, view, figure), ...(tool?.marks(view) ?? [])]}
            follows={followsSelection.value && shown.length > 1}
            inText={figure.inText}
            onPick={act.select}
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

/** The image tabs: one view or all of them, with what the tab's stage found drawn over. */
import "./images.css";
import type { ComponentChildren } from "preact";
import { category } from "../../shared/palette";
import { Legend } from "../parts/Legend";
import { results } from "../state/results";
import { images, scene } from "../state/scene";
import { selectionDetail } from "../state/selectionDetail";
import {
  followsSelection,
  select,
  selection,
  shownView,
  showRejected,
  showView,
  tab,
  withRejected,
  zoomToSelection,
} from "../state/viewState";
import { directionColours } from "./directionColours";
import type { Overlay } from "./drawing";
import { ImageCanvas } from "./ImageCanvas";
import { marksOf } from "./selectionMarks";

/** All views side by side. */
export const ALL = -1;

/** `empty` stands in their place as long as there are none. */
export function ImageViews({ empty }: { empty: ComponentChildren }) {
  void selectionDetail.value;
  const views = scene.value?.views ?? [];
  if (views.length === 0 || images.value.length === 0) {
    return <>{empty}</>;
  }
  const shown =
    shownView.value === ALL ? views.map((_, i) => i) : [Math.min(shownView.value, views.length - 1)];
  return (
    <div class="image-views">
      <div class="toolbar">
        <ViewPicker />
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
            image={images.value[view] as ImageBitmap}
            overlay={overlayOf(view)}
            selection={selection.value}
            marks={marksOf(selection.value, view)}
            follows={followsSelection.value && shown.length > 1}
            onPick={(picked) => {
              select(picked);
            }}
          />
        ))}
      </div>
    </div>
  );
}

/** What the present tab draws over a view. */
function overlayOf(view: number): Overlay {
  const { segments, supports, rejected, regions } = results.value;
  const nothing: Overlay = { segments: null, supports: null };
  const own = segments[view] ?? null;
  switch (tab.value) {
    case "segments":
      return { ...nothing, segments: own, rejected: withRejected.value ? (rejected[view] ?? null) : null };
    case "matches":
      return { segments: own, supports: supports[view] ?? null, segmentsFirst: true };
    case "regions":
      return { ...nothing, regions: regionsOf(regions[view]) };
    case "directions":
      return { ...nothing, segments: own, colours: directionColours(view) };
    case "clusters":
      return { segments: own, supports: supports[view] ?? null };
    default:
      return nothing;
  }
}

/** The regions with colours that tell neighbours apart; made once for each segmentation. */
const tinted = new WeakMap<object, { rings: (readonly [number, number])[][]; colour: string }[]>();

function regionsOf(segmentation: (typeof results.value.regions)[number] | undefined) {
  if (segmentation === undefined) {
    return null;
  }
  const known = tinted.get(segmentation);
  if (known !== undefined) {
    return known;
  }
  const made = segmentation.regions.map(({ rings, mean }, i) => ({
    rings: rings.map((ring) => [...ring]),
    colour: `color-mix(in oklab, ${category(i)} 45%, rgb(${mean}, ${mean}, ${mean}))`,
  }));
  tinted.set(segmentation, made);
  return made;
}

/** One button a view, and before them one for all, unless there is no room for them. */
export function ViewPicker({ withAll = true }: { withAll?: boolean }) {
  const views = scene.value?.views ?? [];
  const shown = withAll ? shownView.value : Math.max(0, shownView.value);
  const choose = (view: number) => () => {
    showView(view);
  };
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">View</legend>
      {withAll && (
        <button type="button" aria-pressed={shownView.value === ALL} onClick={choose(ALL)}>
          All
        </button>
      )}
      {views.map(({ name }, view) => (
        <button key={name} type="button" aria-pressed={shown === view} onClick={choose(view)}>
          {name}
        </button>
      ))}
    </fieldset>
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

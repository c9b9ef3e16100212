/** The image tabs: one view or all of them, with what the tab's stage found drawn over. */
import type { Overlay } from "./drawing";
import { ImageCanvas } from "./ImageCanvas";
import { Legend } from "./Legend";
import { images, results, scene, selection, shownView, tab } from "./state";

/** All views side by side. */
const ALL = -1;

export function ImageViews() {
  const views = scene.value?.views ?? [];
  if (views.length === 0 || images.value.length === 0) {
    return <Empty />;
  }
  const shown =
    shownView.value === ALL ? views.map((_, i) => i) : [Math.min(shownView.value, views.length - 1)];
  return (
    <div class="image-views">
      <div class="toolbar">
        <ViewPicker />
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
            onPick={(picked) => {
              selection.value = picked;
            }}
          />
        ))}
      </div>
    </div>
  );
}

function overlayOf(view: number): Overlay {
  const { segments, supports } = results.value;
  return {
    segments: tab.value === "images" ? null : (segments[view] ?? null),
    supports: tab.value === "matches" ? (supports[view] ?? null) : null,
  };
}

function ViewPicker() {
  const views = scene.value?.views ?? [];
  const choose = (view: number) => () => {
    shownView.value = view;
  };
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">View</legend>
      <button type="button" aria-pressed={shownView.value === ALL} onClick={choose(ALL)}>
        All
      </button>
      {views.map(({ name }, view) => (
        <button key={name} type="button" aria-pressed={shownView.value === view} onClick={choose(view)}>
          {name}
        </button>
      ))}
    </fieldset>
  );
}

function Empty() {
  return (
    <div class="empty">
      <p>No oriented views yet.</p>
      <p class="muted">
        Add photographs with their orientation on the left, or open the demo scene: six aerial views of
        detached houses, reconstructed with one click.
      </p>
    </div>
  );
}

/** The tabs, and below them either images with overlays or the 3D view. */
import { useRef } from "preact/hooks";
import { ImageViews } from "./ImageViews";
import { SpaceView } from "./SpaceView";
import { TABS, type Tab, tab } from "./state";

const TITLES: Record<Tab, string> = {
  images: "Images",
  segments: "Segments",
  matches: "Matches",
  lines: "3D lines",
  halfplanes: "Half-planes",
  facets: "Facets",
  model: "Model",
};

const IMAGE_TABS: readonly Tab[] = ["images", "segments", "matches"];

export function StageView() {
  const list = useRef<HTMLDivElement>(null);
  const isImageTab = IMAGE_TABS.includes(tab.value);
  const onKeyDown = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step !== 0) {
      event.preventDefault();
      const next = (TABS.indexOf(tab.value) + step + TABS.length) % TABS.length;
      tab.value = TABS[next] as Tab;
      (list.current?.children[next] as HTMLElement | undefined)?.focus();
    }
  };
  return (
    <>
      <div
        class="tabs"
        role="tablist"
        aria-label="Stage views"
        tabIndex={-1}
        ref={list}
        onKeyDown={onKeyDown}
      >
        {TABS.map((name) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls="stage-view"
            tabIndex={tab.value === name ? 0 : -1}
            onClick={() => {
              tab.value = name;
            }}
          >
            {TITLES[name]}
          </button>
        ))}
      </div>
      <div id="stage-view" class="stage-view" role="tabpanel" aria-labelledby={`tab-${tab.value}`}>
        {isImageTab && <ImageViews />}
        <SpaceView hidden={isImageTab} />
      </div>
    </>
  );
}

/** The tabs, and below them either images with overlays or the 3D view, above the figure's own laboratory. */
import "./stages.css";
import { useRef } from "preact/hooks";
import { tabsOf, tabTitle } from "../../../stages/catalogue";
import { FIGURES } from "../../../stages/figures";
import { PageLegend } from "../../../stages/PageLegend";
import { pageOf } from "../../../stages/pages";
import type { FigureView } from "../../../stages/stageFigure";
import { FlightProgress } from "../../project/flight/FlightProgress";
import { isCorrecting } from "../../results/corrections/drawn";
import { pageFigure } from "../../selection/selectionQueries";
import { method } from "../../state/parameters";
import { images } from "../../state/scene";
import { showTab, tab, withRejected } from "../../state/viewState";
import type { Overlay } from "../images/drawing";
import { ImageViews } from "../images/ImageViews";
import { SpaceView } from "../space/SpaceView";
import { EmptyStage } from "./EmptyStage";
import { edgeTool } from "./edgeTool";

const NO_OVERLAY: Overlay = { segments: null, supports: null };

/** Drawn anew with whatever of the page's state changes; the tabs and the space are not. */
function PageImages() {
  const figure = pageFigure();
  const tool = tab.value === "images" && isCorrecting.value ? edgeTool(figure) : undefined;
  const { overlay } = FIGURES[tab.value];
  const { Switch } = pageOf(tab.value);
  return (
    <ImageViews
      figure={figure}
      overlay={(view) => overlay?.(view, figure, withRejected.value) ?? NO_OVERLAY}
      switches={Switch !== undefined && <Switch />}
      legend={<PageLegend />}
      empty={<EmptyStage />}
      tool={tool}
    />
  );
}

function PageLab({ Lab }: { Lab: FigureView }) {
  return <Lab figure={pageFigure()} />;
}

export function StageView() {
  const list = useRef<HTMLDivElement>(null);
  const isImageTab = pageOf(tab.value).shows === undefined;
  const names = tabsOf(method.value);
  const Lab = images.value.length > 0 ? FIGURES[tab.value].Lab : undefined;
  const onKeyDown = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step !== 0) {
      event.preventDefault();
      const next = (names.indexOf(tab.value) + step + names.length) % names.length;
      showTab(names[next] ?? tab.value);
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
        {names.map((name) => (
          <button
            key={name}
            id={`tab-${name}`}
            type="button"
            role="tab"
            aria-selected={tab.value === name}
            aria-controls="stage-view"
            tabIndex={tab.value === name ? 0 : -1}
            onClick={() => {
              showTab(name);
            }}
          >
            {tabTitle(name)}
          </button>
        ))}
      </div>
      <div id="stage-view" class="stage-view" role="tabpanel" aria-labelledby={`tab-${tab.value}`}>
        <FlightProgress />
        {isImageTab && <PageImages />}
        <SpaceView hidden={isImageTab} />
        {Lab !== undefined && (
          <section class="lab" aria-label={`${tabTitle(tab.value)}: figure`}>
            <PageLab Lab={Lab} />
          </section>
        )}
      </div>
    </>
  );
}

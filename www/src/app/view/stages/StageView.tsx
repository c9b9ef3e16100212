/** Either images with overlays or the 3D view; of the method above the figure's own laboratory. */
import "./stages.css";
import { tabTitle } from "../../../stages/catalogue";
import { FIGURES } from "../../../stages/figures";
import { PageLegend } from "../../../stages/PageLegend";
import { pageOf } from "../../../stages/pages";
import type { FigureView } from "../../../stages/stageFigure";
import { FlightProgress } from "../../project/flight/FlightProgress";
import { isCorrecting } from "../../results/corrections/drawn";
import { pageFigure } from "../../selection/selectionQueries";
import { images } from "../../state/scene";
import { face, tab, withRejected } from "../../state/viewState";
import type { Overlay } from "../images/drawing";
import { ImageViews } from "../images/ImageViews";
import { ResultViews } from "../space/ResultViews";
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
      switches={
        <>
          <ResultViews />
          {Switch !== undefined && <Switch />}
        </>
      }
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
  const isImageTab = pageOf(tab.value).shows === undefined;
  const Lab = face.value === "method" && images.value.length > 0 ? FIGURES[tab.value].Lab : undefined;
  return (
    // biome-ignore lint/a11y/useAriaPropsSupportedByRole: both roles have names
    <div
      id="stage-view"
      class="stage-view"
      role={face.value === "method" ? "tabpanel" : "group"}
      aria-label={tabTitle(tab.value)}
    >
      <FlightProgress />
      {isImageTab && <PageImages />}
      <SpaceView hidden={isImageTab} />
      {Lab !== undefined && (
        <section class="lab" aria-label={`${tabTitle(tab.value)}: figure`}>
          <PageLab Lab={Lab} />
        </section>
      )}
    </div>
  );
}

/** Project on the left, the stage views in the middle, what they mean and parameters on the right. */

import { FIGURES } from "../../stages/figures";
import { Inspector } from "../inspector/Inspector";
import { Downloads } from "../project/Downloads";
import { KnownFiles } from "../project/known/KnownFiles";
import { KnownFindings } from "../project/known/KnownFindings";
import { Parameters } from "../project/Parameters";
import { Project } from "../project/Project";
import { Comparison } from "../results/comparison/Comparison";
import { Corrections } from "../results/corrections/Corrections";
import { images } from "../state/scene";
import { tourStep } from "../state/tour";
import { tab } from "../state/viewState";
import { TourPanel } from "../tour/TourPanel";
import { AboutFigure } from "../view/figures/AboutFigure";
import { showsEntrance } from "../view/screen/opening";
import { PageTakeAlong } from "../view/stages/PageTakeAlong";
import { StageRail } from "../view/stages/StageRail";
import { StageView } from "../view/stages/StageView";
import { Notices } from "./Notices";

export function Workbench() {
  const isBehind = showsEntrance.value;
  return (
    <div class="columns">
      <aside class="column project" aria-label="Project">
        <Project />
        {!isBehind && <KnownFiles />}
        <Downloads />
      </aside>
      <main class="centre">
        {!isBehind && <Notices />}
        <StageView />
        <StageRail />
      </main>
      <aside class="column details" aria-label="Details">
        {tourStep.value !== null ? (
          <TourPanel />
        ) : (
          images.value.length > 0 && <AboutFigure of={FIGURES[tab.value]} />
        )}
        {tourStep.value === null && images.value.length > 0 && <PageTakeAlong />}
        <Comparison />
        <KnownFindings />
        <Inspector />
        <Corrections />
        <Parameters />
      </aside>
    </div>
  );
}

/** Project on the left, the stage views in the middle, what they mean and parameters on the right. */

import { FIGURES } from "../../stages/figures";
import { Comparison } from "../comparison/Comparison";
import { Corrections } from "../corrections/Corrections";
import { AboutFigure } from "../figures/AboutFigure";
import { Inspector } from "../inspector/Inspector";
import { KnownFiles } from "../known/KnownFiles";
import { KnownFindings } from "../known/KnownFindings";
import { Downloads } from "../project/Downloads";
import { Parameters } from "../project/Parameters";
import { Project } from "../project/Project";
import { showsEntrance } from "../screen/opening";
import { PageTakeAlong } from "../stages/PageTakeAlong";
import { StageRail } from "../stages/StageRail";
import { StageView } from "../stages/StageView";
import { images } from "../state/scene";
import { tourStep } from "../state/tour";
import { tab } from "../state/viewState";
import { TourPanel } from "../tour/TourPanel";
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

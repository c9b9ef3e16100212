/** The view, and one panel: beside the result its buildings, beside the method its rail and what the figure means. */

import { FIGURES } from "../../stages/figures";
import { Inspector } from "../inspector/Inspector";
import { KnownFiles } from "../project/known/KnownFiles";
import { KnownFindings } from "../project/known/KnownFindings";
import { Parameters } from "../project/Parameters";
import { Project } from "../project/Project";
import { Comparison } from "../results/comparison/Comparison";
import { images } from "../state/scene";
import { tourStep } from "../state/tour";
import { face, tab } from "../state/viewState";
import { TourPanel } from "../tour/TourPanel";
import { AboutFigure } from "../view/figures/AboutFigure";
import { ResultPanel } from "../view/result/ResultPanel";
import { showsEntrance } from "../view/screen/opening";
import { hasModel, isRoomy, openPanel, shownPanel } from "../view/screen/panels";
import { PageTakeAlong } from "../view/stages/PageTakeAlong";
import { StageRail } from "../view/stages/StageRail";
import { StageView } from "../view/stages/StageView";
import { Notices } from "./Notices";

export function Workbench() {
  const isBehind = showsEntrance.value;
  const panel = shownPanel.value;
  const of = face.value;
  const isOver = !isRoomy.value && (panel === "project" || (panel === "main" && of === "result"));
  return (
    <div class={`columns ${of} ${panel === null ? "alone" : ""} ${hasModel.value ? "with-model" : ""}`}>
      <StageRail hidden={of !== "method"} />
      <main class="centre">
        {!isBehind && <Notices />}
        <StageView />
        {of === "result" && panel === null && hasModel.value && (
          <button type="button" class="open-panel" onClick={() => openPanel("main")}>
            Buildings
          </button>
        )}
      </main>
      <aside class="column project" aria-label="Project" hidden={panel !== "project"}>
        {isOver && <Close />}
        <Project />
        {!isBehind && <KnownFiles />}
      </aside>
      <aside class="column details" aria-label="Details" hidden={panel !== "main"}>
        {isOver && <Close />}
        {of === "result" ? <ResultPanel /> : <MethodPanel />}
      </aside>
    </div>
  );
}

function Close() {
  return (
    <button
      type="button"
      class="quiet close-panel"
      aria-label="Close the panel"
      onClick={() => openPanel(null)}
    >
      ✕
    </button>
  );
}

function MethodPanel() {
  const hasImages = images.value.length > 0;
  return (
    <>
      {tourStep.value !== null && <TourPanel />}
      {tourStep.value === null && hasImages && (
        <>
          <AboutFigure of={FIGURES[tab.value]} />
          <PageTakeAlong />
        </>
      )}
      <Comparison />
      <KnownFindings />
      <Inspector />
      <Parameters />
    </>
  );
}

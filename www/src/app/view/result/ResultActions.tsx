/** What is done with the result: before there is one it is computed, then it is read, taken along and corrected. */
import "./result.css";
import { stageWords } from "../../../stages/catalogue";
import { isCorrecting, showCorrecting } from "../../results/corrections/drawn";
import { cancel } from "../../session/session";
import { canRun, runAll } from "../../session/stageRuns";
import { phase } from "../../state/activity";
import { inspection } from "../../state/project";
import { exportNames, mainResults } from "../../state/results";
import { stages } from "../../state/stages";
import { showTab } from "../../state/viewState";
import { openPanel } from "../screen/panels";
import { DownloadMenu } from "./DownloadMenu";
import { Report } from "./Report";

export function ResultActions() {
  if (phase.value === "run") {
    return <Running />;
  }
  const hasModel = exportNames.value.includes("model.glb");
  const isOutdated = stages.value.some(({ status }) => status !== "done");
  return (
    <div class="actions">
      {isOutdated && canRun(stages.value.length) && (
        <button type="button" class={hasModel ? "" : "primary"} onClick={() => void runAll()}>
          {hasModel ? "Reconstruct again" : "Reconstruct"}
        </button>
      )}
      {hasModel && <Report />}
      {inspection.value !== null && <DownloadMenu />}
      {mainResults.value.facets !== null && <CorrectButton />}
    </div>
  );
}

/** How far the run is, over all stages. */
function Running() {
  const all = stages.value;
  const now = all.find(({ status }) => status === "running");
  const done = all.reduce((sum, { status, fraction }) => sum + (status === "done" ? 1 : fraction), 0);
  return (
    <div class="actions" data-testid="running">
      <span class="running">
        <span class="muted">{now === undefined ? "Reconstructing" : stageWords(now.name).title}</span>
        <progress max={all.length} value={done} aria-label="Reconstruction" />
      </span>
      {
        // The second click of a double click on "Reconstruct" is meant for that.
        <button type="button" onClick={({ detail }) => void (detail < 2 && cancel())}>
          Cancel
        </button>
      }
    </div>
  );
}

function CorrectButton() {
  const toggle = () => {
    showCorrecting(!isCorrecting.value);
    if (isCorrecting.value) {
      openPanel("main");
      showTab("model");
    }
  };
  return (
    <button type="button" aria-pressed={isCorrecting.value} onClick={toggle}>
      Correct
    </button>
  );
}

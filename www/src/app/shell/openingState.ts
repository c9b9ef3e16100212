/** What the page begins with: the scene of a link, or the project of the last visit. */
import { batch } from "@preact/signals";
import { asksCore } from "../../kinds/kinds";
import { lineEnds } from "../../kinds/parts/shapes";
import type { Selection } from "../../shared/selection";
import type { StageName } from "../../shared/stages";
import { stageOfTab, tabsOf } from "../../stages/catalogue";
import { openDemoIn, restoreWithResults } from "../project/projectActions";
import { readStoredProject } from "../project/storedProject";
import type { Turn } from "../session/actionQueue";
import { actions } from "../session/session";
import { runStages } from "../session/stageRuns";
import { linkedParams, opened } from "../settings/addressLink";
import { method } from "../state/parameters";
import { mainResults, results } from "../state/results";
import { scene } from "../state/scene";
import { resumeDetail } from "../state/selectionDetail";
import { stages } from "../state/stages";
import { select, shownView, showTab, showView, standAt } from "../state/viewState";
import { goToIn } from "../tour/steps";

/** Does the page begin with something? */
export async function isAwaited(): Promise<boolean> {
  const kept = await readStoredProject();
  return opened.scene !== null || (kept !== null && "files" in kept && kept.files.length > 0);
}

export async function restoreOpeningState(): Promise<void> {
  await actions.perform({ kind: "restore", phase: "load" }, restoreIt);
}

async function restoreIt(turn: Turn): Promise<void> {
  const stored = await readStoredProject();
  turn.signal.throwIfAborted();
  // One whose folder the browser asks about is opened at the entrance.
  const kept = stored !== null && "files" in stored ? stored : null;
  // A link to the demo scene means it as it was published; a reload, as it was left.
  if (opened.scene === "demo" && !(kept?.isDemo === true && isReload())) {
    await openDemoIn(turn, opened.tab === null ? null : stageOfTab(opened.tab));
  } else if (kept !== null && kept.files.length > 0) {
    turn.enter("load", "Reading files");
    await restoreWithResults(turn, kept, linkedParams());
    const stage = opened.tab === null ? null : stageOfTab(opened.tab);
    if (stage !== null && scene.value !== null && (!isShown(stage) || asksCore(opened.selection))) {
      await runStages(turn, stage);
    }
  }
  if (scene.value === null) {
    return;
  }
  if (isNewLine(opened.selection)) {
    await runStages(turn, "refinement");
  }
  const tabs = tabsOf(method.value);
  batch(() => {
    if (opened.tab !== null && tabs.includes(opened.tab)) {
      showTab(opened.tab);
    } else if (mainResults.value.glb !== null) {
      showTab("model");
    }
    showView(opened.view ?? shownView.value);
    resumeDetail(opened);
    select(opened.selection);
    standAt(opened.camera);
  });
  if (opened.tourStep !== null && results.value.glb !== null) {
    await goToIn(turn, opened.tourStep);
  }
}

function isReload(): boolean {
  const [visit] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  return visit !== undefined && visit.type !== "navigate";
}

/** Is there something of this stage to be seen? */
function isShown(stage: StageName): boolean {
  return stages.value.some(({ name, status }) => name === stage && status !== "waiting");
}

/** A line that the model adds to the matched ones? */
function isNewLine(picked: Selection | null): boolean {
  return (
    picked?.kind === "line" &&
    results.value.lines !== null &&
    lineEnds(picked.index, results.value).length === 0
  );
}

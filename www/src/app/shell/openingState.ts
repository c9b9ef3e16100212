/** What the page begins with: the scene of a link, or the project of the last visit. */
import { batch } from "@preact/signals";
import type { Selection } from "../../shared/selection";
import type { StageName } from "../../shared/stages";
import { openDemoIn, restoreIn } from "../project/projectActions";
import { readStoredProject, readStoredResults } from "../project/storedProject";
import { showStoredResults } from "../project/storedResults";
import { lineEnds } from "../selection/selectionShapes";
import type { Turn } from "../session/actionQueue";
import { actions } from "../session/session";
import { runStages } from "../session/stageRuns";
import { opened } from "../settings/addressLink";
import { stageOfTab, TABS, type Tab } from "../state/methods";
import { method } from "../state/parameters";
import { results } from "../state/results";
import { scene } from "../state/scene";
import { resumeDetail } from "../state/selectionDetail";
import { stages } from "../state/stages";
import { select, shownView, showTab, showView, standAt } from "../state/viewState";
import { goToIn } from "../tour/lessons";

/** Does the page begin with something? */
export async function isAwaited(): Promise<boolean> {
  return opened.scene !== null || ((await readStoredProject())?.files.length ?? 0) > 0;
}

export async function restoreOpeningState(): Promise<void> {
  await actions.perform({ kind: "restore", phase: "load" }, restoreIt);
}

async function restoreIt(turn: Turn): Promise<void> {
  const kept = await readStoredProject();
  turn.signal.throwIfAborted();
  // A link to the demo scene means it as it was published; a reload, as it was left.
  if (opened.scene === "demo" && !(kept?.isDemo === true && isReload())) {
    await openDemoIn(turn, opened.tab === null ? null : stageOfTab(opened.tab));
  } else if (kept !== null && kept.files.length > 0) {
    turn.enter("load", "Reading files");
    await restoreIn(kept);
    const found = await readStoredResults();
    turn.signal.throwIfAborted();
    if (found !== null && scene.value !== null) {
      showStoredResults(found);
    }
    const stage = opened.tab === null ? null : stageOfTab(opened.tab);
    if (stage !== null && scene.value !== null && (!isShown(stage) || asksCore(opened.selection))) {
      await runStages(turn, stage);
    }
  }
  if (scene.value === null) {
    return;
  }
  if (isNewLine(opened.selection)) {
    await runStages(turn, "facets");
  }
  const tabs: readonly Tab[] = TABS[method.value];
  batch(() => {
    if (opened.tab !== null && tabs.includes(opened.tab)) {
      showTab(opened.tab);
    }
    showView(opened.view ?? shownView.value);
    resumeDetail(opened);
    select(opened.selection);
    standAt(opened.camera);
  });
  if (opened.lesson !== null && results.value.glb !== null) {
    await goToIn(turn, opened.lesson);
  }
}

function isReload(): boolean {
  const [visit] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  return visit !== undefined && visit.type !== "navigate";
}

/** Does the figure of the selected thing ask the core, which must have run then? */
function asksCore(picked: Selection | null): boolean {
  return picked !== null && ["segment", "line", "side", "halfplane"].includes(picked.kind);
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

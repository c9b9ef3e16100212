/** What the page begins with: the scene of a link, or the project of the last visit. */
import { batch } from "@preact/signals";
import type { Selection } from "../../shared/selection";
import { openDemoIn, restoreIn } from "../project/projectActions";
import { readStoredProject } from "../project/storedProject";
import { lineEnds } from "../selection/selectionShapes";
import type { Turn } from "../session/actionQueue";
import { actions } from "../session/session";
import { runStages } from "../session/stageRuns";
import { opened } from "../settings/addressLink";
import { stageOfTab, TABS, type Tab } from "../state/methods";
import { method } from "../state/parameters";
import { results } from "../state/results";
import { scene } from "../state/scene";
import { select, shownView, showTab, showView } from "../state/viewState";
import { goToIn } from "../tour/lessons";

export async function restoreOpeningState(): Promise<void> {
  await actions.perform({ kind: "restore", phase: "load" }, restoreIt);
}

async function restoreIt(turn: Turn): Promise<void> {
  if (opened.scene === "demo") {
    await openDemoIn(turn, opened.tab === null ? null : stageOfTab(opened.tab));
  } else {
    const kept = await readStoredProject();
    turn.signal.throwIfAborted();
    if (kept !== null && kept.files.length > 0) {
      turn.enter("load", "Reading files");
      await restoreIn(kept);
      if (opened.tab !== null && opened.tab !== "images" && scene.value !== null) {
        await runStages(turn, stageOfTab(opened.tab) ?? "model");
      }
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
    select(opened.selection);
  });
  if (opened.lesson !== null && results.value.glb !== null) {
    await goToIn(turn, opened.lesson);
  }
}

/** A line that the model adds to the matched ones? */
function isNewLine(picked: Selection | null): boolean {
  const { lines, facets } = results.value;
  return picked?.kind === "line" && lines !== null && facets === null && lineEnds(picked.index).length === 0;
}

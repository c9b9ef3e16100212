/** What the page begins with: the scene of a link, or the project of the last visit. */
import { batch } from "@preact/signals";
import type { Selection } from "../../shared/selection";
import { openDemo, restoreProject } from "../project/projectActions";
import { readStoredProject } from "../project/storedProject";
import { lineEnds } from "../selection/selectionShapes";
import { runTo } from "../session/stageRuns";
import { opened } from "../settings/addressLink";
import { stageOfTab, TABS, type Tab } from "../state/methods";
import { method } from "../state/parameters";
import { results } from "../state/results";
import { scene } from "../state/scene";
import { select, shownView, showTab, showView } from "../state/viewState";
import { goTo } from "../tour/lessons";

/** Does the page begin with something? */
export async function isAwaited(): Promise<boolean> {
  return opened.scene !== null || ((await readStoredProject())?.files.length ?? 0) > 0;
}

export async function restoreOpeningState(): Promise<void> {
  if (opened.scene === "demo") {
    await openDemo(opened.tab === null ? null : stageOfTab(opened.tab));
  } else {
    const kept = await readStoredProject();
    if (kept !== null && kept.files.length > 0) {
      await restoreProject(kept);
      if (opened.tab !== null && opened.tab !== "images") {
        await runTo(stageOfTab(opened.tab) ?? "model");
      }
    }
  }
  if (scene.value === null) {
    return;
  }
  if (isNewLine(opened.selection)) {
    await runTo("facets");
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
    await goTo(opened.lesson);
  }
}

/** A line that the model adds to the matched ones? */
function isNewLine(picked: Selection | null): boolean {
  const { lines, facets } = results.value;
  return picked?.kind === "line" && lines !== null && facets === null && lineEnds(picked.index).length === 0;
}

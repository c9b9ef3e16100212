/** The page's selection: asks the core about what was picked, and makes the page's state a figure. */

import { effect } from "@preact/signals";
import { questionOf } from "../../kinds/kinds";
import { type Figure, type FigureActions, NO_DETAIL } from "../../stages/figure";
import { actions, ask, hasResults } from "../session/session";
import { runAll } from "../session/stageRuns";
import { notify } from "../state/notices";
import { params } from "../state/parameters";
import { results, shownResultSet } from "../state/results";
import { images, scene } from "../state/scene";
import { selectionDetail, setDetail, takeResumed } from "../state/selectionDetail";
import { runningStage } from "../state/stages";
import { select, selection, shownPlane, shownView, showPlane, showTab, showView } from "../state/viewState";
import { Inquiry } from "./inquiry";

const inquiry = new Inquiry({
  selection: () => selection.peek(),
  results: () => results.peek(),
  detail: () => selectionDetail.peek(),
  setDetail: setDetail,
  ask,
  takeResumed,
});

/** Follows the selection as long as the page is open. */
export function askAboutSelection(): void {
  let last = { set: shownResultSet.peek(), picked: selection.peek() };
  effect(() => {
    const now = { set: shownResultSet.value, picked: selection.value };
    // The same number is another line there; a link names its own.
    if (now.set !== last.set && now.picked === last.picked) {
      select(null);
    }
    last = { ...now, picked: selection.peek() };
  });
  effect(() => {
    void [results.value, runningStage.value];
    const picked = selection.value;
    if (shownResultSet.value === "regions") {
      // The figures of B99 are about its own segments and lines.
      setDetail(NO_DETAIL);
      return;
    }
    if (questionOf(picked, results.peek()) !== null) {
      offerRun();
    }
    void inquiry.follow();
  });
}

/** Compares the selected segment with another candidate, or at another of its points; `isMoved` when the reader moved it. */
export function compareAt(candidate: number, at: number, isMoved?: boolean): Promise<void> {
  return inquiry.compareAt(candidate, at, isMoved);
}

/** Turns the half-plane of the selected side to an angle, radians; `isByHand` when the reader does it. */
export function turnTo(theta: number, isByHand = true): Promise<void> {
  return inquiry.turnTo(theta, isByHand);
}

const ACTIONS: FigureActions = {
  select,
  compareAt: (candidate, at) => {
    const isMoved = at !== selectionDetail.peek().at || selectionDetail.peek().isMoved;
    void inquiry.compareAt(candidate, at, isMoved);
  },
  turnTo: (theta) => void inquiry.turnTo(theta),
  showView,
  showPlane,
  openView: (view) => {
    showView(view);
    showTab("images");
  },
};

/** The page's state as a figure; whoever asks while drawing is drawn again when it changes. */
export function pageFigure(): Figure {
  return {
    scene: scene.value,
    images: images.value,
    results: results.value,
    params: params.value,
    selection: selection.value,
    detail: selectionDetail.value,
    view: shownView.value,
    plane: shownPlane.value,
    inText: false,
    act: ACTIONS,
  };
}

/** The results of an earlier visit are there to be seen; figures ask the core, which has not found them yet. */
function offerRun(): void {
  if (!hasResults() && actions.isIdle) {
    notify({
      severity: "info",
      title: "The figures of what is picked need a run",
      text: "What is shown was found earlier; a run finds the same again.",
      action: { name: "Run all", run: () => void runAll() },
    });
  }
}

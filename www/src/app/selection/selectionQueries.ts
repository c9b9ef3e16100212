/** What follows from a selection: the figures ask the core about the thing that was picked. */
import { effect } from "@preact/signals";
import type { Side, SideTrace } from "../../shared/records";
import { actions, ask, hasResults } from "../session/session";
import { runAll } from "../session/stageRuns";
import { notify } from "../state/notices";
import { results, shownResultSet } from "../state/results";
import { beginDetail, changeDetail, NO_DETAIL, selectionDetail, takeResumed } from "../state/selectionDetail";
import { runningStage } from "../state/stages";
import { select, selection } from "../state/viewState";

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
      beginDetail();
    } else if (picked?.kind === "segment") {
      void askAboutSegment(picked.view, picked.index);
    } else {
      const side = sideOf(picked);
      if (side !== null) {
        void askAboutSide(side.line, side.side);
      } else {
        beginDetail();
      }
    }
  });
}

/** Compares the selected segment with another candidate, or at another of its points; `isMoved` when the reader moved it. */
export async function compareAt(
  candidate: number,
  at: number,
  isMoved = selectionDetail.peek().isMoved,
): Promise<void> {
  changeDetail({ candidate, at, isMoved });
  const picked = selection.peek();
  const found = selectionDetail.peek().story?.candidates[candidate];
  if (picked?.kind !== "segment" || found === undefined) {
    changeDetail({ correspondence: null });
    return;
  }
  await latest("correspondence", async () => {
    const answer = await ask("correspondence", picked.view, picked.index, found.view, found.segment, at);
    if (selection.peek() === picked) {
      changeDetail({ correspondence: answer });
    }
  });
}

/** Turns the half-plane of the selected side to an angle, radians; `isByHand` when the reader does it. */
export async function turnTo(theta: number, isByHand = true): Promise<void> {
  changeDetail({ theta, isTurned: isByHand });
  const side = selectionDetail.peek().side;
  if (side === null) {
    return;
  }
  await latest("warped", async () => {
    const { theta: wanted } = selectionDetail.peek();
    const warped = await ask("warped", side.line, side.side === "left", wanted);
    if (selectionDetail.peek().side === side) {
      changeDetail({ warped });
    }
  });
}

/** The side of a line that a selection means: a line's better half-plane, or its left side. */
export function sideOf(picked: typeof selection.value): { line: number; side: Side } | null {
  const halfPlanes = results.peek().halfPlanes;
  switch (picked?.kind) {
    case "side":
      return picked;
    case "halfplane":
      return halfPlanes?.[picked.index] ?? null;
    case "line": {
      const own = halfPlanes?.filter(({ line }) => line === picked.index) ?? [];
      const best = own.reduce<(typeof own)[number] | null>(
        (a, b) => (a !== null && a.similarity >= b.similarity ? a : b),
        null,
      );
      return { line: picked.index, side: best?.side ?? "left" };
    }
    default:
      return null;
  }
}

/** The results of an earlier visit are there to be seen; figures ask the core, which has not found them yet. */
function offerRun(): void {
  if (!hasResults() && actions.isIdle) {
    notify({
      severity: "info",
      title: "The figures of what is picked need a run",
      text: "The results are those of the last visit.",
      action: { name: "Run all", run: () => void runAll() },
    });
  }
}

async function askAboutSegment(view: number, segment: number): Promise<void> {
  if (results.peek().matching !== null) {
    offerRun();
  }
  const story = results.peek().matching === null ? null : await ask("segmentStory", view, segment);
  const now = selection.peek();
  if (now?.kind === "segment" && now.view === view && now.index === segment) {
    beginDetail({ story });
    const point = story === null ? null : takeResumed().point;
    await compareAt(point?.[0] ?? 0, point?.[1] ?? NO_DETAIL.at, point !== null);
  }
}

async function askAboutSide(line: number, side: Side): Promise<void> {
  if (results.peek().halfPlanes === null) {
    beginDetail();
    return;
  }
  offerRun();
  const found = await ask("side", line, side === "left");
  const now = sideOf(selection.peek());
  if (now?.line === line && now.side === side) {
    beginDetail({ side: found, theta: bestTheta(found) });
    const thetaDeg = found === null ? null : takeResumed().thetaDeg;
    await turnTo(thetaDeg === null ? bestTheta(found) : (thetaDeg * Math.PI) / 180, thetaDeg !== null);
  }
}

/** The angle of the half-plane, or of the highest sample where there is none. */
export function bestTheta(side: SideTrace | null): number {
  if (side === null) {
    return 0;
  }
  const own = results
    .peek()
    .halfPlanes?.find((halfPlane) => halfPlane.line === side.line && halfPlane.side === side.side);
  if (own !== undefined) {
    return own.theta;
  }
  const { thetas, similarity } = side.curve;
  const highest = Math.max(0, ...similarity);
  return highest > 0 ? (thetas[similarity.indexOf(highest)] ?? 0) : 0;
}

const running = new Set<string>();
const waiting = new Map<string, () => Promise<void>>();

/** Runs a task, or, while one of its kind runs, the newest one after it: a drag asks no more than is answered. */
async function latest(kind: string, task: () => Promise<void>): Promise<void> {
  if (running.has(kind)) {
    waiting.set(kind, task);
    return;
  }
  running.add(kind);
  try {
    await task();
  } finally {
    running.delete(kind);
  }
  const next = waiting.get(kind);
  if (next !== undefined) {
    waiting.delete(kind);
    await latest(kind, next);
  }
}

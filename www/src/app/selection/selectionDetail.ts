/** What follows from a selection: the figures ask the core about the thing that was picked. */
import { effect } from "@preact/signals";
import type { SideName, SideTrace } from "../../shared/traces";
import { ask } from "../session/session";
import {
  NOTHING_POINTED,
  type Pointing,
  pointing,
  results,
  runningStage,
  selection,
  shownKeeper,
} from "../state/state";

/** Follows the selection as long as the page is open. */
export function followSelection(): void {
  let last = { keeper: shownKeeper.peek(), picked: selection.peek() };
  effect(() => {
    const now = { keeper: shownKeeper.value, picked: selection.value };
    // The same number is another line there; a link names its own.
    if (now.keeper !== last.keeper && now.picked === last.picked) {
      selection.value = null;
    }
    last = { ...now, picked: selection.peek() };
  });
  effect(() => {
    void [results.value, runningStage.value];
    const picked = selection.value;
    if (shownKeeper.value === "regions") {
      // The figures of B99 are about its own segments and lines.
      pointing.value = NOTHING_POINTED;
    } else if (picked?.kind === "segment") {
      void pointAtSegment(picked.view, picked.index);
    } else {
      const side = sideOf(picked);
      if (side !== null) {
        void pointAtSide(side.line, side.side);
      } else {
        pointing.value = NOTHING_POINTED;
      }
    }
  });
}

/** Compares the selected segment with another candidate, or at another of its points; `isMoved` when the reader moved it. */
export async function compareAt(
  candidate: number,
  at: number,
  isMoved = pointing.peek().isMoved,
): Promise<void> {
  change({ candidate, at, isMoved });
  const picked = selection.peek();
  const found = pointing.peek().story?.candidates[candidate];
  if (picked?.kind !== "segment" || found === undefined) {
    change({ correspondence: null });
    return;
  }
  await latest("correspondence", async () => {
    const answer = await ask("correspondence", picked.view, picked.index, found.view, found.segment, at);
    if (selection.peek() === picked) {
      change({ correspondence: answer });
    }
  });
}

/** Turns the half-plane of the selected side to an angle, radians; `isByHand` when the reader does it. */
export async function turnTo(theta: number, isByHand = true): Promise<void> {
  change({ theta, isTurned: isByHand });
  const side = pointing.peek().side;
  if (side === null) {
    return;
  }
  await latest("warped", async () => {
    const { theta: wanted } = pointing.peek();
    const warped = await ask("warped", side.line, side.side === "left", wanted);
    if (pointing.peek().side === side) {
      change({ warped });
    }
  });
}

/** The side of a line that a selection means: a line's better half-plane, or its left side. */
export function sideOf(picked: typeof selection.value): { line: number; side: SideName } | null {
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

async function pointAtSegment(view: number, segment: number): Promise<void> {
  const story = results.peek().matching === null ? null : await ask("segmentStory", view, segment);
  const now = selection.peek();
  if (now?.kind === "segment" && now.view === view && now.index === segment) {
    pointing.value = { ...NOTHING_POINTED, story };
    await compareAt(0, NOTHING_POINTED.at, false);
  }
}

async function pointAtSide(line: number, side: SideName): Promise<void> {
  if (results.peek().halfPlanes === null) {
    pointing.value = NOTHING_POINTED;
    return;
  }
  const found = await ask("side", line, side === "left");
  const now = sideOf(selection.peek());
  if (now?.line === line && now.side === side) {
    pointing.value = { ...NOTHING_POINTED, side: found, theta: bestTheta(found) };
    await turnTo(bestTheta(found), false);
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

function change(part: Partial<Pointing>): void {
  pointing.value = { ...pointing.peek(), ...part };
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

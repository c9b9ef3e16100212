/** Finds among the results what a step of the tour is best shown by, and selects it. */
import { effect } from "@preact/signals";
import type { SideTrace } from "../../shared/records";
import { bestTheta } from "../selection/inquiry";
import { compareAt, turnTo } from "../selection/selectionQueries";
import { ask } from "../session/session";
import { results } from "../state/results";
import { type SelectionDetail, selectionDetail } from "../state/selectionDetail";
import { tourStep } from "../state/tour";
import { select } from "../state/viewState";
import { fallOf, highestSim, roofEnds, roofSegments, type SideOfLine, slopedHalfPlanes } from "./examples";

/** So many segments are compared at so many points. */
const TRIED = { segments: 8, points: 13 };
/** What a student can reach by dragging, with something to spare. */
const CLEAR_CORRELATION = 0.93;
const FIRST_VIEW = 0;

/** The segment whose best pair correlates well at one place and worst at another, with the point at the worst. */
export async function showVaryingSegment(): Promise<void> {
  const isHere = stay();
  let best = { index: -1, at: 0.5, range: 0 };
  for (const index of roofSegments(results.value, FIRST_VIEW).slice(0, TRIED.segments)) {
    const tried = await correlationsAlong(index);
    const [least, most] = [tried.reduce(lower, tried[0]), tried.reduce(higher, tried[0])];
    if (least !== undefined && most !== undefined && most.value > CLEAR_CORRELATION) {
      const range = most.value - least.value;
      best = range > best.range ? { index, at: least.at, range } : best;
    }
  }
  if (best.index < 0 || !isHere()) {
    return;
  }
  select({ kind: "segment", view: FIRST_VIEW, index: best.index });
  await known(({ correspondence }) => correspondence !== null);
  await compareAt(0, best.at, false);
}

/** The half-plane whose Sim falls most, turned to where it is low. */
export async function showSteepFall(): Promise<void> {
  const isHere = stay();
  const { halfPlanes } = results.value;
  const fell = (await tracesOf(slopedHalfPlanes(results.value))).map((side) => ({
    side,
    ...fallOf(side, bestTheta(side, results.value)),
  }));
  const steepest = fell.reduce((a, b) => (b.by > a.by ? b : a), fell[0] as (typeof fell)[number]);
  if (steepest === undefined || !isHere()) {
    return;
  }
  const { line, side } = steepest.side;
  select({
    kind: "halfplane",
    index: halfPlanes?.findIndex((one) => one.line === line && one.side === side) ?? 0,
  });
  await known(({ warped }) => warped !== null);
  await turnTo(steepest.at, false);
}

/** The line at a roof's end whose outer side agrees least at any angle, from its inner side. */
export async function showRoofEnd(): Promise<void> {
  const isHere = stay();
  const outer = await tracesOf(roofEnds(results.value));
  const flattest = outer.reduce((a, b) => (highestSim(b) < highestSim(a) ? b : a), outer[0] as SideTrace);
  const inner = results.value.halfPlanes?.findIndex(({ line }) => line === flattest?.line) ?? -1;
  if (inner >= 0 && isHere()) {
    select({ kind: "halfplane", index: inner });
  }
}

/** Whether the tour is still at the step of now: the core takes its time to answer. */
function stay(): () => boolean {
  const step = tourStep.peek();
  return () => tourStep.peek() === step;
}

interface Tried {
  at: number;
  value: number;
}

const lower = (a: Tried | undefined, b: Tried) => (a !== undefined && a.value <= b.value ? a : b);
const higher = (a: Tried | undefined, b: Tried) => (a !== undefined && a.value >= b.value ? a : b);

/** Correlations of a segment with its best candidate, at places along it. */
async function correlationsAlong(segment: number): Promise<Tried[]> {
  const other = (await ask("segmentStory", FIRST_VIEW, segment))?.candidates[0];
  const tried: Tried[] = [];
  for (let i = 1; other !== undefined && i < TRIED.points; i += 1) {
    const at = i / TRIED.points;
    const found = await ask("correspondence", FIRST_VIEW, segment, other.view, other.segment, at);
    if (found?.correlation != null) {
      tried.push({ at, value: found.correlation });
    }
  }
  return tried;
}

async function tracesOf(sides: readonly SideOfLine[]): Promise<SideTrace[]> {
  const found: SideTrace[] = [];
  for (const { line, side } of sides) {
    const trace = await ask("side", line, side === "left");
    if (trace !== null) {
      found.push(trace);
    }
  }
  return found;
}

/** Resolves once the figures know something of the selection. */
function known(isKnown: (detail: SelectionDetail) => boolean): Promise<void> {
  return new Promise((resolve) => {
    const stop = effect(() => {
      if (isKnown(selectionDetail.value)) {
        queueMicrotask(() => stop());
        resolve();
      }
    });
  });
}

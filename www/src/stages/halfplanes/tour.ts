/** The tour: one angle, and where a roof ends. */
import { degreesOf } from "../../app/parts/numberText";
import { REJECTION_WORDS } from "../../app/parts/reasonText";
import { bestTheta } from "../../app/selection/inquiry";
import { turnTo } from "../../app/selection/selectionQueries";
import { ask } from "../../app/session/session";
import { results } from "../../app/state/results";
import { selectionDetail } from "../../app/state/selectionDetail";
import { select } from "../../app/state/viewState";
import { DEGREE } from "../../shared/linear";
import { isRejected, type Side, type SideTrace } from "../../shared/records";
import type { Results } from "../list";
import { known, roofLines, type StageStep, stay } from "../tourStep";

export default [
  {
    title: "One angle is unknown",
    text: "A 3D line fixes the plane through it except for one angle, θ. Each θ warps the views differently; only one makes them agree.",
    question: "Drag θ until the windows are alike, without the Best button: within 2° of the maximum.",
    answer: () => {
      const { side } = selectionDetail.value;
      return `Sim is ${(side === null ? 0 : highestSim(side)).toFixed(2)} at its peak, at ${degreesOf(bestTheta(side, results.value)).toFixed(0)}°. The more texture a roof has and the longer the baseline, the sharper the peak.`;
    },
    pointsTo: "theta",
    prepare: () => void showSteepFall(),
    isFound: () => {
      const { side, theta, isTurned } = selectionDetail.value;
      return side !== null && isTurned && Math.abs(theta - bestTheta(side, results.value)) < 2 * DEGREE;
    },
  },
  {
    title: "Where a roof ends",
    text: "On this side of the line there is a roof, and Sim has one clear peak. Beyond the line the roof ends: no angle makes the views agree, and that side is rejected. In space it is a thin red line.",
    question: "Show the other side of the line, and see how high its curve rises.",
    answer: () => {
      const { side } = selectionDetail.value;
      return side === null
        ? ""
        : `Its highest Sim is ${highestSim(side).toFixed(2)}, and the side is rejected: ${REJECTION_WORDS[side.rejection ?? ""]}. So eaves and rakes differ from ridges, without any knowledge of roofs.`;
    },
    hint: () => {
      const { side } = selectionDetail.value;
      return side === null || !isRejected(side)
        ? null
        : `This side was rejected for another reason: ${REJECTION_WORDS[side.rejection ?? ""]}.`;
    },
    pointsTo: "other-side",
    prepare: () => void showRoofEnd(),
    isFound: () => selectionDetail.value.side !== null && agreesNowhere(selectionDetail.value.side),
  },
] satisfies readonly StageStep[];

/** So far from its peak a curve is asked how deep it falls: near enough to be the same peak's flank, far enough to be seen. */
const AWAY = { least: 25 * DEGREE, most: 45 * DEGREE };

/** Flatter half-planes are found without turning. */
const LEAST_SLOPE = 15 * DEGREE;

/** Reasons that say: the views agree at no angle. */
const NO_AGREEMENT: ReadonlySet<string> = new Set(["low_peak", "no_valid_view"]);

interface SideOfLine {
  line: number;
  side: Side;
}

/** The half-plane whose Sim falls most, turned to where it is low. */
async function showSteepFall(): Promise<void> {
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
async function showRoofEnd(): Promise<void> {
  const isHere = stay();
  const outer = await tracesOf(roofEnds(results.value));
  const flattest = outer.reduce((a, b) => (highestSim(b) < highestSim(a) ? b : a), outer[0] as SideTrace);
  const inner = results.value.halfPlanes?.findIndex(({ line }) => line === flattest?.line) ?? -1;
  if (inner >= 0 && isHere()) {
    select({ kind: "halfplane", index: inner });
  }
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

/** Half-planes of facets that are steep enough for the angle to matter. */
export function slopedHalfPlanes(all: Pick<Results, "halfPlanes" | "facets">): SideOfLine[] {
  const used = new Set(all.facets?.flatMap(({ half_planes }) => half_planes ?? []));
  return (all.halfPlanes ?? []).filter(({ theta }, i) => used.has(i) && Math.abs(theta) > LEAST_SLOPE);
}

/** How much Sim falls from the peak at `theta` (radians), and at which angle. */
export function fallOf(
  { curve: { thetas, similarity } }: SideTrace,
  theta: number,
): { at: number; by: number } {
  const away = thetas.map((one, i) => ({ at: one, sim: similarity[i] ?? 0 }));
  const near = away.reduce((a, b) => (Math.abs(b.at - theta) < Math.abs(a.at - theta) ? b : a), {
    at: Number.POSITIVE_INFINITY,
    sim: 0,
  });
  const lowest = away
    .filter(({ at }) => Math.abs(at - theta) >= AWAY.least && Math.abs(at - theta) <= AWAY.most)
    .reduce((a, b) => (b.sim < a.sim ? b : a), { at: theta, sim: Number.POSITIVE_INFINITY });
  return { at: lowest.at, by: Math.max(0, near.sim - lowest.sim) };
}

/** Lines along which a roof ends: a facet's half-plane on one side, and on the other no agreement at any angle. */
export function roofEnds(all: Pick<Results, "halfPlanes" | "facets" | "sides">): SideOfLine[] {
  const roof = roofLines(all);
  const accepted = new Set(all.halfPlanes?.map(({ line }) => line));
  return all.sides.filter(
    ({ line, rejection }) => accepted.has(line) && roof.has(line) && rejection === "low_peak",
  );
}

/** Whether the views agree on a side at no angle, and that is why it was rejected. */
export function agreesNowhere({ rejection }: Pick<SideTrace, "rejection">): boolean {
  return rejection !== null && NO_AGREEMENT.has(rejection);
}

/** The highest Sim of a curve. */
function highestSim({ curve }: SideTrace): number {
  return Math.max(0, ...curve.similarity);
}

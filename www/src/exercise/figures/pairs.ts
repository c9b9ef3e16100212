/** Which two views know a line best: B99 3.4 and figure 9, by the covariance of the line in space. */
import { add, DEGREE, distance2, dot, norm, sub, thetaFrame, unit } from "../../shared/linear";
import type { ViewInfo } from "../../shared/records";
import type { Figure } from "../../stages/figure";
import { figureExercise, type Outcome } from "./judgeFigure";
import { edgeAlong, imageIn, lineOf, type Point } from "./truth";

/** Of an edge in an image, pixels. */
const SIGMA_PX = 0.5;
/** A baseline so near to the direction of the line says little, degrees. */
const ALONG_DEG = 35;
const SHORT = 0.6;
const MOST_VIEWS = 4;

/** How far the image of a line moves across itself, pixels per metre, when the line moves along two directions across it. */
function sensitivity(view: ViewInfo, [p, q]: readonly [Point, Point]): readonly [number, number] {
  const { left, up } = thetaFrame(p, q);
  const [a, b] = [imageIn(view, p), imageIn(view, q)];
  const length = distance2(a, b);
  const across = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length] as const;
  return [left, up].map((way) => {
    const step = 0.01;
    const moved = imageIn(view, add(p, way, step));
    return ((moved[0] - a[0]) * across[0] + (moved[1] - a[1]) * across[1]) / step;
  }) as [number, number];
}

/** The larger standard deviation across a line that some views see, metres. */
export function sigmaAcross(views: readonly ViewInfo[], line: readonly [Point, Point]): number {
  const all = views.map((view) => sensitivity(view, line));
  const n = (i: 0 | 1, j: 0 | 1) => all.reduce((sum, one) => sum + (one[i] * one[j]) / SIGMA_PX ** 2, 0);
  const [a, b, c] = [n(0, 0), n(0, 1), n(1, 1)];
  // The smaller eigenvalue of the information.
  const least = (a + c) / 2 - Math.sqrt(((a - c) / 2) ** 2 + b * b);
  return 1 / Math.sqrt(Math.max(least, 1e-12));
}

export interface Pair {
  names: string;
  sigma: number;
  baseline: number;
  /** Between baseline and line, degrees. */
  angle: number;
}

/** The pairs of the first views that see the picked line. */
export function pairsOf(shown: Figure): Pair[] {
  const { selection, scene, results } = shown;
  const line = selection?.kind === "line" ? lineOf(shown, selection.index) : null;
  const record = selection?.kind === "line" ? results.records[selection.index] : undefined;
  if (line === null || record === undefined) {
    return [];
  }
  const views = record.supports.slice(0, MOST_VIEWS).flatMap(({ view }) => scene?.views[view] ?? []);
  return views.flatMap((first, i) =>
    views.slice(i + 1).map((second) => {
      const base = sub(second.center, first.center);
      const cosine = Math.abs(dot(unit(base), unit(sub(line[1], line[0]))));
      return {
        names: `${first.name} and ${second.name}`,
        sigma: sigmaAcross([first, second], line),
        baseline: norm(base),
        angle: Math.acos(Math.min(1, cosine)) / DEGREE,
      };
    }),
  );
}

const best = (pairs: readonly Pair[]) => pairs.reduce((a, b) => (a.sigma <= b.sigma ? a : b));
const isAlong = ({ angle }: Pair) => angle < ALONG_DEG;
const isShort = (pair: Pair, of: Pair) => pair.baseline < SHORT * of.baseline;

/** What is to be said of a pair. */
export function outcomeOf(pair: Pair, pairs: readonly Pair[]): Outcome {
  const most = best(pairs);
  // What does not differ is as good.
  if (pair.sigma <= 1.02 * most.sigma) {
    return "right";
  }
  if (isAlong(pair)) {
    return { mistake: "baseline along the line" };
  }
  return { mistake: isShort(pair, most) ? "short baseline" : "not the best" };
}

export const bestPair = figureExercise({
  name: "bestPair",
  title: "The pair that knows a line best",
  lesson: "triangulation",
  source: "B99 3.4, figure 9",
  text: "The picked line is seen by several views. If only two of them had it, each with the same accuracy in the image, from which pair would the line be known with the least [[standard-deviation]] across it? (The line runs as the photographs show; the views are named in the order of the flight: s1 on the way out, s2 on the way back.)",
  figure: "line-accuracy",
  asks: { by: "choice", choices: (shown) => pairsOf(shown).map(({ names }) => names) },
  begin: async ({ shown }) => {
    const lines = shown.results.records.flatMap((record, index) => {
      const line = lineOf(shown, index);
      return line !== null && record.supports.length >= MOST_VIEWS && edgeAlong(line)?.kind === "eave"
        ? [{ index, pairs: pairsOf({ ...shown, selection: { kind: "line", index } }) }]
        : [];
    });
    // One on which the mistakes can be made.
    const tells = ({ pairs }: { pairs: Pair[] }) =>
      pairs.some((one) => isAlong(one) && one.sigma > 1.1 * best(pairs).sigma) &&
      pairs.some((one) => !isAlong(one) && isShort(one, best(pairs)));
    const chosen = lines.find(tells) ?? lines[0];
    return chosen === undefined ? {} : { select: `line:${chosen.index}` };
  },
  judge: async ({ shown }, given): Promise<Outcome> => {
    const pairs = pairsOf(shown);
    const pair = pairs.find(({ names }) => names === given);
    return pair === undefined ? { form: "Choose a pair." } : outcomeOf(pair, pairs);
  },
  answer: async ({ shown }) => {
    const pairs = pairsOf(shown);
    if (pairs.length === 0) {
      return { words: "" };
    }
    const { names, sigma } = best(pairs);
    const of = (one: Pair) => `${one.names} ${(100 * one.sigma).toFixed(0)} cm`;
    return {
      words: `${names}: ${(100 * sigma).toFixed(0)} cm, with ${SIGMA_PX} px in the image (${pairs.map(of).join("; ")}).`,
      given: names,
    };
  },
  solution:
    "The planes through the line and the two centres must meet at a large angle: a long baseline, across the line.",
  mistakes: {
    "baseline along the line":
      "The views lie nearly behind each other, as seen along the line: both centres are nearly in one plane with it, and the two planes hardly cut each other.",
    "short baseline": "The centres are close together: the planes through the line meet at a small angle.",
    "not the best": "This pair is not bad, but another one has a longer baseline across the line.",
  },
});

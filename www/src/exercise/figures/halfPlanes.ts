/** At a half-plane: the angle of the roof, and how fast the images disagree beside it. */
import { DEGREE } from "../../shared/linear";
import type { Side, SideTrace } from "../../shared/records";
import type { Figure } from "../../stages/figure";
import { type Asked, figureExercise, mistakeAmong, type Outcome } from "./judgeFigure";
import { edgeAlong, faceBeside, lineOf } from "./truth";

/** What B99 4.4 states of a well textured face, degrees. */
const TOLERANCE_DEG = 2;

interface TrueSide {
  line: number;
  side: Side;
  /** Degrees. */
  theta: number;
  best: number;
}

/** The half-planes whose roof is known. */
function trueSides(shown: Figure): TrueSide[] {
  return (shown.results.halfPlanes ?? []).flatMap(({ line, side, theta }) => {
    const ends = lineOf(shown, line);
    const beside = ends === null || edgeAlong(ends) === null ? null : faceBeside(ends, side);
    return beside === null ? [] : [{ line, side, theta: beside.theta, best: theta / DEGREE }];
  });
}

function thetaOfRoof({ detail, results }: Figure): number | null {
  const ends = detail.side === null ? null : lineOf({ results } as Figure, detail.side.line);
  return ends === null || detail.side === null ? null : (faceBeside(ends, detail.side.side)?.theta ?? null);
}

const nameOf = ({ line, side }: Pick<TrueSide, "line" | "side">) => `side:${line}.${side}`;

export const turnToRoof = figureExercise({
  name: "turnToRoof",
  title: "The angle of a roof",
  lesson: "roofs",
  source: "B99 4.1, figures 10 to 12",
  text: "Turn the [[half-plane]] until it lies in the roof: within 2° of the true angle, which is all that a well textured face allows.",
  figure: "theta-sweep",
  begin: async ({ shown }) => {
    const found = trueSides(shown).find(
      ({ theta, best }) => Math.abs(best - theta) < 1 && Math.abs(theta) > 15 && Math.abs(theta) < 40,
    );
    return found === undefined ? {} : { select: nameOf(found), theta: 0 };
  },
  judge: async ({ shown }): Promise<Outcome> => {
    const truth = thetaOfRoof(shown);
    if (truth === null) {
      return { form: "Another line is picked than that of the exercise. Begin again." };
    }
    const given = shown.detail.theta / DEGREE;
    const isNear = (angle: number) => Math.abs(given - angle) <= TOLERANCE_DEG;
    if (isNear(truth)) {
      return "right";
    }
    return (
      mistakeAmong({
        level: isNear(0),
        "wrong sign": isNear(-truth),
        "from the vertical": isNear(Math.sign(truth) * (90 - Math.abs(truth))),
      }) ?? { wrong: `${given.toFixed(1)}° is ${given > truth ? "too high" : "too low"}.` }
    );
  },
  answer: async ({ shown }) => {
    const truth = thetaOfRoof(shown) ?? 0;
    return { words: `θ = ${truth.toFixed(1)}°`, state: { theta: Math.round(2 * truth) / 2 } };
  },
  solution: "Sim(θ) has its peak at the angle of the roof: there the windows of all views look alike.",
  mistakes: {
    level: "The half-plane is level. This is where it would be on a flat roof.",
    "wrong sign":
      "The angle has the wrong sign: θ is positive where the half-plane rises away from the line, as from an eave to the ridge.",
    "from the vertical": "This is the angle from the vertical. θ is 0 where the half-plane is level.",
  },
});

/** Sim(θ) of the side at an angle, radians. */
function simAt({ curve: { thetas, similarity } }: SideTrace, theta: number): number {
  const i = Math.max(
    1,
    thetas.findIndex((one) => one >= theta),
  );
  const [a = 0, b = 1] = thetas.slice(i - 1, i + 1);
  const [u = 0, v = 0] = similarity.slice(i - 1, i + 1);
  return b === a ? u : u + ((theta - a) / (b - a)) * (v - u);
}

function peakOf({ curve: { thetas, similarity } }: SideTrace): { theta: number; sim: number; least: number } {
  const sim = Math.max(...similarity);
  return { theta: thetas[similarity.indexOf(sim)] ?? 0, sim, least: Math.min(...similarity) };
}

/** The first angle beyond the peak, upwards, where Sim has fallen to half of it, radians. */
function halfAbove(side: SideTrace): number | null {
  const { theta, sim } = peakOf(side);
  const { thetas, similarity } = side.curve;
  return thetas.find((one, i) => one > theta && (similarity[i] ?? 1) <= sim / 2) ?? null;
}

async function sideWithFall({ shown, ask }: Asked): Promise<Partial<{ select: string; theta: number }>> {
  for (const one of trueSides(shown)) {
    const side = await ask("side", one.line, one.side === "left");
    const above = side === null ? null : halfAbove(side);
    if (
      side !== null &&
      above !== null &&
      above < 70 * DEGREE &&
      peakOf(side).least < 0.4 * peakOf(side).sim
    ) {
      return { select: nameOf(one), theta: 0 };
    }
  }
  return {};
}

export const halfOfPeak = figureExercise({
  name: "halfOfPeak",
  title: "How sharp a peak is",
  lesson: "homography",
  source: "B99 4.1, figures 12 to 14",
  text: "The [[homography|homographies]] H(θ) lay the views onto each other only where the plane is right. Turn the [[half-plane]] beyond the peak, upwards, to where Sim(θ) has first fallen to half of it: a sharp peak is a well known angle.",
  figure: "theta-sweep",
  begin: sideWithFall,
  judge: async ({ shown }): Promise<Outcome> => {
    const { side, theta } = shown.detail;
    const above = side === null ? null : halfAbove(side);
    if (side === null || above === null) {
      return { form: "Another line is picked than that of the exercise. Begin again." };
    }
    const { theta: peak, sim, least } = peakOf(side);
    const here = simAt(side, theta);
    const isNear = (angle: number) => Math.abs(theta - angle) <= TOLERANCE_DEG * DEGREE;
    if (isNear(above)) {
      return "right";
    }
    return (
      mistakeAmong({
        "at the peak": isNear(peak),
        "below the peak": theta < peak && Math.abs(here - sim / 2) <= 0.08 * sim,
        "at the bottom": here <= least + 0.05 * sim,
        "half of the angle": isNear(peak / 2),
      }) ?? { wrong: `Here Sim(θ) is ${here.toFixed(2)}, and half of its peak is ${(sim / 2).toFixed(2)}.` }
    );
  },
  answer: async ({ shown }) => {
    const { side } = shown.detail;
    const above = side === null ? null : halfAbove(side);
    const theta = (above ?? 0) / DEGREE;
    return { words: `θ = ${theta.toFixed(1)}°`, state: { theta: Math.round(2 * theta) / 2 } };
  },
  solution: "From the peak to the right, along the thick curve, down to half of its height.",
  mistakes: {
    "at the peak": "Here Sim(θ) has its peak. Where it has fallen to half of it is asked for.",
    "below the peak":
      "Here Sim(θ) is half of its peak as well, but on the other side: below the angle of the roof.",
    "at the bottom": "Here Sim(θ) is lowest. Half of its peak is higher.",
    "half of the angle": "This is half of the angle of the peak. It is Sim(θ) that is to be half as high.",
  },
});

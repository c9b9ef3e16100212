/** In the photographs: which edge of a roof a segment shows, and which segment of another view shows the same. */

import type { FigureState } from "../../element/figureState";
import { lengthOf } from "../../shared/flatArrays";
import type { PairCandidate } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import type { Figure } from "../../stages/figure";
import { type Asked, figureExercise, type Outcome } from "./judgeFigure";
import { distanceFrom, edgeShown, type RoofEdge, type Stretch, segmentOf, shows } from "./truth";

/** Next to an edge, but not on it, pixels: a gutter, a wall, a shadow. */
const BESIDE_PX = 14;
const LEAST_PX = 25;

const isLong = (at: Stretch) => lengthOf(at) >= LEAST_PX;

/** The segments of a view, and the edge that each of them shows. */
export function edgesOfView(
  shown: Figure,
  view: number,
): { index: number; edge: RoofEdge | null; at: Stretch }[] {
  const info = shown.scene?.views[view];
  const count = (shown.results.segments[view]?.length ?? 0) / 4;
  return Array.from({ length: count }, (_, index) => index).flatMap((index) => {
    const at = segmentOf(shown, view, index);
    return at === null || info === undefined ? [] : [{ index, edge: edgeShown(info, at), at }];
  });
}

const KIND_MISTAKES: Readonly<Record<string, string>> = {
  ridge: "a ridge",
  hip: "a hip",
  rake: "a rake",
  abutment: "an abutment",
};

export const pickEave = figureExercise({
  name: "pickEave",
  title: "An eave in the photograph",
  lesson: "pinhole",
  source: "B99 3.2",
  text: "Pick a [[segment]] that shows an [[eave]]: the level lower border of a roof.",
  figure: "segments",
  begin: async () => ({ view: 0 }),
  judge: async ({ shown }) => {
    const { selection } = shown;
    if (selection?.kind === "rejectedSegment") {
      return { form: "This line was rejected and is no segment. Pick one of the others." };
    }
    if (selection?.kind !== "segment") {
      return { form: "Pick a segment in the photograph." };
    }
    const edge = ownEdge(shown);
    if (edge === null) {
      return { mistake: "no edge of a roof" };
    }
    const mistake = KIND_MISTAKES[edge.kind];
    return mistake === undefined ? "right" : { mistake };
  },
  answer: async ({ shown }) => {
    const all = edgesOfView(shown, 0).filter(({ edge, at }) => edge?.kind === "eave" && isLong(at));
    const [first] = all;
    return {
      words: `Segments ${all.map(({ index }) => numberOf(index)).join(", ")} of ${shown.scene?.views[0]?.name ?? ""}, and those of the other views.`,
      ...(first === undefined ? {} : { state: { select: `segment:0.${first.index}`, view: 0 } }),
    };
  },
  solution:
    "An eave is the border of a roof that is level and lies lowest: the long sides of a gable, all sides of a hip roof.",
  mistakes: {
    "a ridge":
      "This is a ridge: two faces of the roof meet there, at its top. An eave has a roof on one side only.",
    "a hip": "This is a hip: it rises from a corner of the eaves to the ridge, with a face on either side.",
    "a rake": "This is a rake: the sloping border of a gable. An eave is level.",
    "an abutment": "Here a roof ends at a higher wall. An eave is its lower border.",
    "no edge of a roof":
      "The scene has no edge of a roof here: it is a line on the ground, on a wall, within a roof, or the border of a shadow.",
  },
});

/** The edge that the picked segment shows. */
function ownEdge(shown: Figure): RoofEdge | null {
  const { selection, scene } = shown;
  if (selection?.kind !== "segment") {
    return null;
  }
  const at = segmentOf(shown, selection.view, selection.index);
  const view = scene?.views[selection.view];
  return at === null || view === undefined ? null : edgeShown(view, at);
}

type Truth = "same" | "beside" | "other" | "none";

/** What a candidate shows of an edge. */
function truthOf(
  shown: Figure,
  edge: RoofEdge,
  { view, segment }: Pick<PairCandidate, "view" | "segment">,
): Truth {
  const info = shown.scene?.views[view];
  const at = segmentOf(shown, view, segment);
  if (info === undefined || at === null) {
    return "none";
  }
  if (shows(edge, info, at)) {
    return "same";
  }
  if (distanceFrom(edge, info, at) < BESIDE_PX) {
    return "beside";
  }
  return edgeShown(info, at) === null ? "none" : "other";
}

/** A segment of the first view whose candidates are of the wanted kinds; the candidate to begin with. */
async function segmentWith(
  { shown, ask }: Asked,
  begins: (candidates: readonly PairCandidate[], truths: readonly Truth[]) => number,
): Promise<Partial<FigureState>> {
  for (const { index, edge, at } of edgesOfView(shown, 0)) {
    if (edge !== null && isLong(at)) {
      const story = await ask("segmentStory", 0, index);
      const candidates = story?.candidates ?? [];
      const first = begins(
        candidates,
        candidates.map((one) => truthOf(shown, edge, one)),
      );
      if (first >= 0) {
        return { select: `segment:0.${index}`, point: [first, 0.5] };
      }
    }
  }
  return {};
}

/** The candidate that is compared; why there is none. */
function compared(shown: Figure): { edge: RoofEdge; candidate: PairCandidate } | { form: string } {
  const edge = ownEdge(shown);
  const candidate = shown.detail.story?.candidates[shown.detail.candidate];
  if (edge === null) {
    return { form: "Another segment is picked than that of the exercise. Begin again." };
  }
  return candidate === undefined ? { form: "Choose a candidate." } : { edge, candidate };
}

const MISTAKE_OF: Readonly<Record<Exclude<Truth, "same">, string>> = {
  beside: "beside the edge",
  other: "another edge",
  none: "no edge of a roof",
};

export const trueCandidate = figureExercise({
  name: "trueCandidate",
  title: "The true candidate in the beam",
  lesson: "epipolar",
  source: "B99 3.1, figures 1 and 2",
  text: "The picked segment shows an edge of a roof. Several segments lie in its [[epipolar-beam|epipolar beams]] in the other views. Choose a [[candidate]] that shows the same edge.",
  figure: "epipolar-beam",
  begin: (of) =>
    segmentWith(of, (_, truths) =>
      truths.includes("same") && truths.filter((one) => one !== "same").length > 1
        ? truths.findIndex((one) => one !== "same")
        : -1,
    ),
  judge: async ({ shown }): Promise<Outcome> => {
    const found = compared(shown);
    if ("form" in found) {
      return found;
    }
    const truth = truthOf(shown, found.edge, found.candidate);
    return truth === "same" ? "right" : { mistake: MISTAKE_OF[truth] };
  },
  answer: async ({ shown }) => candidateAnswer(shown, (truth) => truth === "same"),
  solution:
    "Compare what lies on both sides of the two segments, in the windows and in the photographs: the same roof on the one, the same ground on the other. The score alone does not decide.",
  mistakes: {
    "beside the edge":
      "This segment runs along the edge, a little beside it: the wall, the gutter or the border of a shadow. The edge itself is elsewhere.",
    "another edge": "This is an edge of a roof, but another one: parallel edges lie in the same beam.",
    "no edge of a roof":
      "This segment shows no edge of a roof at all. That it lies in the beam does not say much.",
  },
});

function candidateAnswer(shown: Figure, isRight: (truth: Truth, candidate: PairCandidate) => boolean) {
  const edge = ownEdge(shown);
  const candidates = shown.detail.story?.candidates ?? [];
  const right = candidates.flatMap((one, i) =>
    edge !== null && isRight(truthOf(shown, edge, one), one) ? [i] : [],
  );
  const name = (i: number) => {
    const { view = 0, segment = 0 } = candidates[i] ?? {};
    return `${shown.scene?.views[view]?.name ?? view} · ${numberOf(segment)}`;
  };
  const [first] = right;
  return {
    words: right.map(name).join("; "),
    ...(first === undefined ? {} : { state: { point: [first, 0.5] as const } }),
  };
}

const isVerified = ({ predictions }: PairCandidate) => predictions.some(({ verified }) => verified !== null);

export const falseCandidate = figureExercise({
  name: "falseCandidate",
  title: "What the third view contradicts",
  lesson: "trifocal",
  source: "B99 3.2, figure 3",
  text: "A pair of segments [[transfer|predicts]] a line in each further view. Choose a [[candidate]] that is wrong and that is found out: no other view has a segment where the pair predicts its line.",
  figure: "point-transfer",
  begin: (of) =>
    segmentWith(of, (candidates, truths) => {
      const isFoundOut = candidates.some((one, i) => truths[i] !== "same" && !isVerified(one));
      return isFoundOut ? truths.indexOf("same") : -1;
    }),
  judge: async ({ shown }): Promise<Outcome> => {
    const found = compared(shown);
    if ("form" in found) {
      return found;
    }
    if (truthOf(shown, found.edge, found.candidate) === "same") {
      return { mistake: "the true candidate" };
    }
    if (found.candidate.predictions.length === 0) {
      return { mistake: "nothing predicted" };
    }
    return isVerified(found.candidate) ? { mistake: "verified by chance" } : "right";
  },
  answer: async ({ shown }) =>
    candidateAnswer(
      shown,
      (truth, one) => truth !== "same" && one.predictions.length > 0 && !isVerified(one),
    ),
  solution:
    "In the third view the predicted line of a wrong pair falls where there is no segment. Two views alone cannot say so: every candidate fulfils their geometry.",
  mistakes: {
    "the true candidate": "This candidate shows the same edge of the roof: the pair is right.",
    "verified by chance":
      "This candidate is wrong, but another view happens to have a segment near the predicted line. So it takes more than one further view, or the photographs themselves.",
    "nothing predicted":
      "This pair predicts no line: the planes through both segments nearly coincide, and where they meet is not determined.",
  },
});

/** So near to the highest or lowest correlation. */
const NEARLY = 0.03;
const STEPS = 50;

/** The correlation at places along the segment, with the candidate that is compared; null where there is none. */
async function correlations({ shown, ask }: Asked): Promise<(number | null)[]> {
  const { selection, detail } = shown;
  const candidate = detail.story?.candidates[detail.candidate];
  if (selection?.kind !== "segment" || candidate === undefined) {
    return [];
  }
  const all: (number | null)[] = [];
  for (let i = 0; i <= STEPS; i += 1) {
    const { view, index } = selection;
    const at = await ask("correspondence", view, index, candidate.view, candidate.segment, i / STEPS);
    all.push(at?.correlation ?? null);
  }
  return all;
}

const known = (all: readonly (number | null)[]) => all.filter((one) => one !== null);

export const bestWindows = figureExercise({
  name: "bestWindows",
  title: "Where two windows agree best",
  lesson: "correlation",
  source: "B99 3.1, figure 4",
  text: "The segment and its first candidate show the same edge, and yet their [[correlation]] differs along it. Move the point x along the segment to where the two [[correlation-window|windows]] agree best: within 0.03 of the highest correlation.",
  figure: "correlation-windows",
  begin: (of) =>
    segmentWith(of, (candidates, truths) =>
      truths[0] === "same" && truths.length > 1 && (candidates[0]?.score ?? 0) > 0.5 ? 0 : -1,
    ),
  judge: async (of): Promise<Outcome> => {
    const { detail } = of.shown;
    if (detail.story === null) {
      return { form: "Another segment is picked than that of the exercise. Begin again." };
    }
    if (detail.candidate !== 0) {
      return { mistake: "another candidate" };
    }
    const here = detail.correspondence?.correlation ?? null;
    if (here === null) {
      return { mistake: "no common point" };
    }
    const all = known(await correlations(of));
    const [least, most] = [Math.min(...all), Math.max(...all)];
    if (here >= most - NEARLY) {
      return "right";
    }
    return here <= least + NEARLY
      ? { mistake: "where they agree least" }
      : { wrong: `Here the correlation is ${here.toFixed(2)}; elsewhere on the segment it is higher.` };
  },
  answer: async (of) => {
    const all = await correlations(of);
    const most = Math.max(...known(all));
    const at = all.indexOf(most) / STEPS;
    return { words: `At ${at.toFixed(2)} of the segment: ${most.toFixed(2)}.`, state: { point: [0, at] } };
  },
  solution:
    "Correlation is high where both windows have the same strong structure, such as a corner or a change of material, and low where one of them sees something that hides the roof.",
  mistakes: {
    "where they agree least": "Here the two windows agree least of all places on the segment.",
    "no common point":
      "Here the epipolar line of x meets the candidate beyond its ends, so that there is nothing to compare.",
    "another candidate": "This is another candidate. The first one shows the same edge.",
  },
});

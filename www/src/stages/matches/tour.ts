/** The tour: beams, and points of them. */
import { counted } from "../../app/parts/counted";
import { compareAt } from "../../app/selection/selectionQueries";
import { ask } from "../../app/session/session";
import { params } from "../../app/state/parameters";
import { results } from "../../app/state/results";
import { selectionDetail } from "../../app/state/selectionDetail";
import { select, showView } from "../../app/state/viewState";
import { ALL_VIEWS } from "../figure";
import type { Results } from "../list";
import { segmentLength } from "../segments/tour";
import { known, roofLines, type StageStep, stay } from "../tourStep";

const HIGH_CORRELATION = 0.9;

export default [
  {
    title: "The epipolar beam",
    text: "Where can the same edge lie in another view? Between the epipolar lines of its end points, cut to the heights that roofs can have.",
    question: "Pick a segment that has candidates in at least three other views.",
    answer: () =>
      `${counted(selectionDetail.value.story?.candidates.length ?? 0, "candidates")} in ${counted(candidateViews(), "views")}: the beam is short because the heights are known roughly.`,
    hint: () =>
      selectionDetail.value.story === null
        ? null
        : `It has candidates in ${counted(candidateViews(), "other views")}.`,
    prepare: () => {
      showView(ALL_VIEWS);
    },
    isFound: () => candidateViews() >= 3,
  },
  {
    title: "Point by point",
    text: "A point x of the segment corresponds to x′, where its epipolar line meets the candidate. The windows about both are compared. Here the point is where they differ most.",
    question: `Drag the point along the segment until the correlation exceeds ${HIGH_CORRELATION}.`,
    answer: () => {
      const least = params.value["matching"]?.["edgel_correlation"];
      return `Now it is ${selectionDetail.value.correspondence?.correlation?.toFixed(2)}: both windows show the same place. The score of the pair is the mean of all correlations along it that exceed ${least}.`;
    },
    prepare: () => {
      showView(ALL_VIEWS);
      void showVaryingSegment();
    },
    isFound: () => {
      const { isMoved, correspondence } = selectionDetail.value;
      return isMoved && (correspondence?.correlation ?? 0) > HIGH_CORRELATION;
    },
  },
] satisfies readonly StageStep[];

function candidateViews(): number {
  return new Set(selectionDetail.value.story?.candidates.map(({ view }) => view)).size;
}

/** So many segments are compared at so many points. */
const TRIED = { segments: 8, points: 13 };

/** What a student can reach by dragging, with something to spare. */
const CLEAR_CORRELATION = 0.93;

const FIRST_VIEW = 0;

/** The segment whose best pair correlates well at one place and worst at another, with the point at the worst. */
async function showVaryingSegment(): Promise<void> {
  const isHere = stay();
  let best = { index: -1, at: 0.5, range: 0 };
  for (const index of roofSegments(results.value, FIRST_VIEW).slice(0, TRIED.segments)) {
    const tried = (await correlationsAlong(index)).sort((a, b) => a.value - b.value);
    const [least, most] = [tried[0], tried.at(-1)];
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

interface Tried {
  at: number;
  value: number;
}

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

/** The segments of a view that show a side of a facet, the longest first. */
export function roofSegments(all: Pick<Results, "segments" | "records" | "facets">, view: number): number[] {
  const roof = roofLines(all);
  return all.records
    .flatMap(({ supports }, line) => (roof.has(line) ? supports : []))
    .flatMap((support) => (support.view === view ? support.segments : []))
    .sort((a, b) => segmentLength(all, view, b) - segmentLength(all, view, a));
}

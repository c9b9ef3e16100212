/** The guided tour: eight steps through B99 and one through W96, in the views themselves, on the demo scene. */
import { effect } from "@preact/signals";
import { isRejected } from "../../shared/records";
import { openDemoIn } from "../project/projectActions";
import { bestTheta, turnTo } from "../selection/selectionQueries";
import type { Turn } from "../session/actionQueue";
import { actions } from "../session/session";
import { chooseMethod, runEverything } from "../session/stageRuns";
import { throughView } from "../space/Photograph";
import type { Method, Tab } from "../state/methods";
import { method } from "../state/parameters";
import { files, isDemo } from "../state/project";
import { results } from "../state/results";
import { selectionDetail } from "../state/selectionDetail";
import { freshStages, stages } from "../state/stages";
import { lessonStep, showLesson } from "../state/tour";
import {
  beforeGrowing,
  select,
  selection,
  showBeforeGrowing,
  showTab,
  showView,
  tab,
} from "../state/viewState";

export interface LessonStep {
  title: string;
  text: string;
  question: string;
  /** What is said once the answer was found. */
  answer: string;
  method: Method;
  tab: Tab;
  /** Selects what the step is about. */
  prepare?: () => void;
  /** Has the student found it? Read from the state of the views alone. */
  isFound: () => boolean;
}

const DEGREE = Math.PI / 180;
const ALL_VIEWS = -1;

export const LESSONS: readonly LessonStep[] = [
  {
    title: "Straight edges",
    text: "Everything begins with edgels linked into straight segments. A roof edge is rarely found whole in every view.",
    question: "Find the longest segment that you can: pick one of more than 100 pixels.",
    answer: "Long segments are ridges and eaves; their direction is known to a tenth of a degree.",
    method: "lines",
    tab: "segments",
    isFound: () => {
      const picked = selection.value;
      return picked?.kind === "segment" && lengthOf(picked.view, picked.index) > 100;
    },
  },
  {
    title: "The epipolar beam",
    text: "Where can the same edge lie in another view? Between the epipolar lines of its end points, cut to the heights that roofs can have.",
    question: "Pick a segment that has candidates in at least three other views.",
    answer: "The beam is short because the heights are known roughly: that leaves few candidates.",
    method: "lines",
    tab: "matches",
    prepare: () => {
      showView(ALL_VIEWS);
    },
    isFound: () => new Set(selectionDetail.value.story?.candidates.map(({ view }) => view)).size >= 3,
  },
  {
    title: "Point by point",
    text: "A point x of the segment corresponds to x′, where its epipolar line meets the candidate. The windows about both are compared.",
    question: "Drag the point along the segment until the correlation exceeds 0.9.",
    answer:
      "Where the windows show the same roof, they correlate; near occlusions they do not. The score is the mean of all that exceed 0.65.",
    method: "lines",
    tab: "matches",
    prepare: () => {
      showView(ALL_VIEWS);
      selectMatchedSegment();
    },
    isFound: () => {
      const { isMoved, correspondence } = selectionDetail.value;
      return isMoved && (correspondence?.correlation ?? 0) > 0.9;
    },
  },
  {
    title: "Merging and growing",
    text: "A 3D line collects fragments from all views: where one view has a gap, another has not.",
    question: "Switch between Before growing and After. Which lines become longer? Pick one.",
    answer: "Ridges gain most: they run across chimneys and shadows that break their segments.",
    method: "lines",
    tab: "lines",
    prepare: () => {
      showBeforeGrowing(true);
    },
    isFound: () => !beforeGrowing.value && selection.value?.kind === "line",
  },
  {
    title: "One angle is left",
    text: "A line fixes a plane but for the angle θ. Each θ warps the views differently; only one makes them agree.",
    question: "Drag θ until the windows are alike, without the Best button: within 2° of the maximum.",
    answer:
      "That is the paper's own accuracy for θ. The curve is as sharp as the roof is textured and the baseline long.",
    method: "lines",
    tab: "halfplanes",
    prepare: () => {
      selectClearHalfPlane();
      void turnAway();
    },
    isFound: () => {
      const { side, theta, isTurned } = selectionDetail.value;
      return side !== null && isTurned && Math.abs(theta - bestTheta(side)) < 2 * DEGREE;
    },
  },
  {
    title: "Occlusion",
    text: "Beyond a rake or an eave there is no roof: no angle makes the views agree, and the side is rejected. It is drawn as a thin red line.",
    question: "Pick a red line, and read in the inspector why it was rejected.",
    answer: "Low peaks and flat curves tell eaves from ridges, without any knowledge of roofs.",
    method: "lines",
    tab: "halfplanes",
    prepare: () => {
      select(null);
    },
    isFound: () => selectionDetail.value.side !== null && isRejected(selectionDetail.value.side),
  },
  {
    title: "Planes",
    text: "Half-planes that share a plane form a group. Its border lines, and where it meets other planes, close the facet.",
    question: "Pick a group of at least four lines.",
    answer: "Ridge, eave and both rakes: a whole facet, each line found on its own.",
    method: "lines",
    tab: "groups",
    isFound: () => {
      const picked = selection.value;
      const members = picked?.kind === "group" ? results.value.grouping?.groups[picked.index]?.members : [];
      return new Set(members?.map(({ line }) => line)).size >= 4;
    },
  },
  {
    title: "The model",
    text: "Facets, walls to the ground, textures from the photographs.",
    question:
      "Look through the camera of a view (bottom right of the picture) and fade its photograph in and out.",
    answer: "Where model and photograph part, the model is wrong: the plainest check there is.",
    method: "lines",
    tab: "model",
    isFound: () => throughView.value !== null,
  },
  {
    title: "Another way: object space",
    text: "Wiman and Axelsson match nothing between images. Each image line of a main direction is a line in the plane across it; where lines of many views meet, there is a roof edge.",
    question: "Pick a ring in the cluster plane, and see its line in every view.",
    answer: "Nothing was compared pixel by pixel: geometry and description length alone chose the line.",
    method: "rectangles",
    tab: "clusters",
    prepare: () => {
      showView(ALL_VIEWS);
    },
    isFound: () => selection.value?.kind === "line" && tab.value === "clusters",
  },
];

export function startTour(): void {
  void goTo(0);
}

export function endTour(): void {
  showLesson(null);
}

/** Opens a step: its method run to the end on the demo scene, its view, and what it is about. */
export async function goTo(step: number): Promise<void> {
  if (LESSONS[step] === undefined) {
    endTour();
    return;
  }
  showLesson(step);
  await actions.perform({ kind: "tour", name: "step", phase: "load" }, async (turn) => {
    // Steps that were passed while this one waited need no run of their own.
    await goToIn(turn, lessonStep.value ?? step);
  });
}

/** The same as part of another action. */
export async function goToIn(turn: Turn, step: number): Promise<void> {
  const lesson = LESSONS[step];
  if (lesson === undefined) {
    return;
  }
  showLesson(step);
  if (files.value.length === 0) {
    await openDemoIn(turn, null);
  }
  if (method.value !== lesson.method) {
    chooseMethod(lesson.method);
  }
  if (freshStages.value < stages.value.length) {
    await runEverything(turn);
  }
  if (lessonStep.value === step) {
    select(null);
    showTab(lesson.tab);
    lesson.prepare?.();
  }
}

/** Turns the half-plane far off, as soon as its curve is known. */
async function turnAway(): Promise<void> {
  const known = new Promise<void>((resolve) => {
    const stop = effect(() => {
      if (selectionDetail.value.warped !== null) {
        queueMicrotask(() => stop());
        resolve();
      }
    });
  });
  await known;
  await turnTo(selectionDetail.peek().theta - 35 * DEGREE, false);
}

/** Whether the tour runs on the scene that it was written for. */
export function isOnDemo(): boolean {
  return files.value.length === 0 || isDemo.value;
}

function lengthOf(view: number, index: number): number {
  const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] =
    results.value.segments[view]?.subarray(4 * index, 4 * index + 4) ?? [];
  return Math.hypot(x1 - x0, y1 - y0);
}

/** The longest segment of the first view that supports a 3D line. */
function selectMatchedSegment(): void {
  const own = results.value.records.flatMap(({ supports }) =>
    supports.filter(({ view }) => view === 0).flatMap(({ segments }) => segments),
  );
  const longest = own.reduce((best, one) => (lengthOf(0, one) > lengthOf(0, best) ? one : best), own[0] ?? 0);
  select({ kind: "segment", view: 0, index: longest });
}

/** The half-plane with the highest Sim at an angle that is worth looking for. */
function selectClearHalfPlane(): void {
  const all = results.value.halfPlanes ?? [];
  const sloped = all
    .map((one, index) => ({ one, index }))
    .filter(({ one }) => Math.abs(one.theta) > 15 * DEGREE);
  const best = sloped.reduce(
    (a, b) => (b.one.similarity > a.one.similarity ? b : a),
    sloped[0] ?? ({ one: all[0], index: 0 } as never),
  );
  if (best?.one !== undefined) {
    select({ kind: "halfplane", index: best.index });
  }
}

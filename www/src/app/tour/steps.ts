/** The guided tour: eleven steps through B99 and one through W96, in the views themselves, on the demo scene. */
import { isRejected } from "../../shared/records";
import { counted } from "../parts/counted";
import { degreesOf, percentText } from "../parts/numberText";
import { REJECTION_WORDS } from "../parts/reasonText";
import { openDemoIn } from "../project/projectActions";
import { bestTheta } from "../selection/inquiry";
import type { Turn } from "../session/actionQueue";
import { actions } from "../session/session";
import { chooseMethod, runEverything } from "../session/stageRuns";
import { throughView } from "../space/Photograph";
import type { Method, Tab } from "../state/methods";
import { method, params } from "../state/parameters";
import { files, isDemo } from "../state/project";
import { results } from "../state/results";
import { selectionDetail } from "../state/selectionDetail";
import { freshStages, stages } from "../state/stages";
import { showTourStep, tourStep } from "../state/tour";
import {
  beforeGrowing,
  select,
  selection,
  showBeforeGrowing,
  showTab,
  showView,
  tab,
} from "../state/viewState";
import {
  agreesNowhere,
  type CoplanarSetParts,
  type CornerParts,
  coplanarSetParts,
  cornerParts,
  type DensePlaneParts,
  densePlaneParts,
  facetOfSegment,
  groupParts,
  growthOf,
  highestSim,
  segmentLength,
} from "./examples";
import { showRoofEnd, showSteepFall, showVaryingSegment } from "./prepare";

export interface TourStep {
  title: string;
  text: string;
  question: string;
  /** What is said once the answer was found, in the numbers of what was picked. */
  answer: () => string;
  /** Why what is picked is not the answer; null where nothing is picked. */
  hint?: () => string | null;
  method: Method;
  tab: Tab;
  /** The control that the question is about: the style sheet marks it, wherever it stands. */
  pointsTo?: "growing" | "theta" | "other-side" | "camera";
  /** Selects what the step is about. */
  prepare?: () => void;
  /** Has the student found it? Read from the state of the views alone. */
  isFound: () => boolean;
}

const DEGREE = Math.PI / 180;
const ALL_VIEWS = -1;
const LONG_PX = 60;
const GREW_M = 0.5;
const HIGH_CORRELATION = 0.9;

export const STEPS: readonly TourStep[] = [
  {
    title: "Straight edges",
    text: "Everything begins with edgels linked into straight segments. A roof edge is rarely found whole in every view, and the longest segments need not be roofs.",
    question: `Pick a segment at the edge of a roof, longer than ${LONG_PX} pixels.`,
    answer: () => {
      const { length, facet } = pickedSegment();
      return `${length.toFixed(0)} px, at a side of facet ${facet} of the finished model. One photograph alone cannot tell it from a kerb: that takes the other views.`;
    },
    hint: () => {
      const { length, facet } = pickedSegment();
      if (length === 0) {
        return null;
      }
      return facet === null
        ? `${length.toFixed(0)} px long, but no facet of the model has it as a side: kerbs, paths and shadows are straight, too.`
        : `It is at a side of facet ${facet}, but ${length.toFixed(0)} px long: look for a longer one.`;
    },
    method: "lines",
    tab: "segments",
    isFound: () => {
      const { length, facet } = pickedSegment();
      return facet !== null && length > LONG_PX;
    },
  },
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
    method: "lines",
    tab: "matches",
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
    method: "lines",
    tab: "matches",
    prepare: () => {
      showView(ALL_VIEWS);
      void showVaryingSegment();
    },
    isFound: () => {
      const { isMoved, correspondence } = selectionDetail.value;
      return isMoved && (correspondence?.correlation ?? 0) > HIGH_CORRELATION;
    },
  },
  {
    title: "Merging and growing",
    text: "A 3D line collects fragments from all views: where one view has a gap, another has not.",
    question: `Switch between Before growing and After, and pick a line that became at least ${GREW_M} m longer.`,
    answer: () => {
      const { line, before, after } = pickedLine();
      return `Line ${line} showed ${before.toFixed(1)} m in one piece before, and is ${after.toFixed(1)} m long now.`;
    },
    hint: () => {
      const { line, before, after } = pickedLine();
      if (line === null) {
        return null;
      }
      return beforeGrowing.value
        ? "This is before growing."
        : `Line ${line} is ${after.toFixed(1)} m long, ${before.toFixed(1)} m before: look for one that gained more.`;
    },
    method: "lines",
    tab: "lines",
    pointsTo: "growing",
    prepare: () => {
      showBeforeGrowing(true);
    },
    isFound: () => {
      const { line, before, after } = pickedLine();
      return !beforeGrowing.value && line !== null && before > 0 && after - before >= GREW_M;
    },
  },
  {
    title: "One angle is unknown",
    text: "A 3D line fixes the plane through it except for one angle, θ. Each θ warps the views differently; only one makes them agree.",
    question: "Drag θ until the windows are alike, without the Best button: within 2° of the maximum.",
    answer: () => {
      const { side } = selectionDetail.value;
      return `Sim is ${(side === null ? 0 : highestSim(side)).toFixed(2)} at its peak, at ${degreesOf(bestTheta(side, results.value)).toFixed(0)}°. The more texture a roof has and the longer the baseline, the sharper the peak.`;
    },
    method: "lines",
    tab: "halfplanes",
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
    method: "lines",
    tab: "halfplanes",
    pointsTo: "other-side",
    prepare: () => void showRoofEnd(),
    isFound: () => selectionDetail.value.side !== null && agreesNowhere(selectionDetail.value.side),
  },
  {
    title: "Dense planes",
    text: "Not every roof has a line that starts its plane. So small patches are matched all over the plan, by their texture alone, and those in one plane are joined. They find lawns and trees as well: what is a building follows from height, roughness and colour.",
    question: "Pick a plane that is most probably a building, and that a facet of the model has.",
    answer: () => {
      const found = pickedDensePlane();
      return found === null ? "" : `${denseWords(found)} ${halfPlaneWords(found)}`;
    },
    hint: () => {
      const found = pickedDensePlane();
      if (found === null) {
        return null;
      }
      return found.name === "building"
        ? "Most probably a building, but no facet of the model has this plane."
        : `Most probably ${found.name} (${percentText(found.probability)}): look for another colour.`;
    },
    method: "lines",
    tab: "dense",
    isFound: () => {
      const found = pickedDensePlane();
      return found?.name === "building" && found.facets.length > 0;
    },
  },
  {
    title: "Planes",
    text: "Half-planes that share a plane form a group. Its border lines, and where it meets other planes, close the facet.",
    question: "Pick a group of at least four lines that became a facet.",
    answer: () => {
      const { lines, facets } = pickedGroup();
      return `${counted(lines, "lines")}, each found on its own, lie in one plane: facet ${facets.join(", ")} of the model.`;
    },
    hint: () => {
      const { lines, facets } = pickedGroup();
      if (lines === 0) {
        return null;
      }
      return facets.length === 0
        ? `${counted(lines, "lines")}, but no facet: nothing shows that there is a roof in this plane.`
        : `Facet ${facets.join(", ")}, from ${counted(lines, "lines")}: look for a group with more.`;
    },
    method: "lines",
    tab: "groups",
    isFound: () => {
      const { lines, facets } = pickedGroup();
      return lines >= 4 && facets.length > 0;
    },
  },
  {
    title: "The model",
    text: "Facets, walls to the ground, textures from the photographs.",
    question:
      "Choose a view in the marked list “Free camera”: you look through its camera, and the slider below fades its photograph in and out.",
    answer: () =>
      "Where the edges of the model and of the photograph do not coincide, the model is wrong: the plainest check there is.",
    method: "lines",
    tab: "model",
    pointsTo: "camera",
    isFound: () => throughView.value !== null,
  },
  {
    title: "Coplanar lines",
    text: "Another partner of the project looked for faces, not for half-planes: lines that lie in one plane are grouped, the convex hull of their ends is closed to a polygon by right angles and symmetry, and the photographs verify it.",
    question:
      "Pick a polygon of a facet of the model in which a side without a line was made square or mirrored.",
    answer: () => {
      const found = pickedSet();
      return found === null
        ? ""
        : `${counted(found.lines, "lines")} lie in one plane. ${counted(found.moved, "sides")} without a line close their polygon, by right angles or symmetry.`;
    },
    hint: () => {
      const found = pickedSet();
      if (found === null) {
        return null;
      }
      return found.moved === 0
        ? "Every side of this one lies on a line: look for another."
        : "No facet of the model has this polygon: it may lie on the ground.";
    },
    method: "coplanar",
    tab: "coplanar",
    isFound: () => {
      const found = pickedSet();
      return found !== null && found.moved > 0 && found.facets.length > 0;
    },
  },
  {
    title: "Corners as wholes",
    text: "A third partner matched no lines at all, but corners with everything that belongs to them: the edges that meet there and the regions between. What borders what in the images borders it in space too, so that one corner proposes several planes at once.",
    question: "Pick a corner that proposes two planes or more, verified by the photographs.",
    answer: () => {
      const found = pickedCorner();
      return found === null
        ? ""
        : `${counted(found.views, "views")} show it with ${counted(found.edges, "edges")}. The regions between these lie in ${counted(found.planes, "planes")}: no line was matched, and no plane sought.`;
    },
    hint: () => {
      const found = pickedCorner();
      return found === null || found.planes > 1
        ? null
        : "One plane or none: look for a corner where three edges meet.";
    },
    method: "adjacency",
    tab: "adjacency",
    isFound: () => (pickedCorner()?.planes ?? 0) > 1,
  },
  {
    title: "Another way: object space",
    text: "Wiman and Axelsson match nothing between images. Each image line of a main direction is a line in the plane across it; where lines of several views meet, there is an edge in space.",
    question: "Pick a ring in the cluster plane, and see its line in every view.",
    answer: () =>
      `Boundaries of regions in ${counted(pickedViews(), "views")} meet there. Nothing was compared pixel by pixel: geometry and description length alone chose the line.`,
    hint: () => (selection.value?.kind === "cluster" ? "This one was rejected: pick a large ring." : null),
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
  showTourStep(null);
}

/** Opens a step: its method run to the end on the demo scene, its view, and what it is about. */
export async function goTo(step: number): Promise<void> {
  if (STEPS[step] === undefined) {
    endTour();
    return;
  }
  showTourStep(step);
  await actions.perform({ kind: "tour", name: "step", phase: "load" }, async (turn) => {
    // Steps that were passed while this one waited need no run of their own.
    await goToIn(turn, tourStep.value ?? step);
  });
}

/** The same as part of another action. */
export async function goToIn(turn: Turn, step: number): Promise<void> {
  const shown = STEPS[step];
  if (shown === undefined) {
    return;
  }
  showTourStep(step);
  if (files.value.length === 0) {
    await openDemoIn(turn, null);
  }
  if (method.value !== shown.method) {
    chooseMethod(shown.method);
  }
  if (freshStages.value < stages.value.length) {
    await runEverything(turn);
  }
  if (tourStep.value === step) {
    select(null);
    showTab(shown.tab);
    shown.prepare?.();
  }
}

/** Whether the tour runs on the scene that it was written for. */
export function isOnDemo(): boolean {
  return files.value.length === 0 || isDemo.value;
}

/** Of the picked segment; no length where none is picked. */
function pickedSegment(): { length: number; facet: number | null } {
  const picked = selection.value;
  return picked?.kind === "segment"
    ? {
        length: segmentLength(results.value, picked.view, picked.index),
        facet: facetOfSegment(results.value, picked.view, picked.index),
      }
    : { length: 0, facet: null };
}

function candidateViews(): number {
  return new Set(selectionDetail.value.story?.candidates.map(({ view }) => view)).size;
}

function pickedLine(): { line: number | null; before: number; after: number } {
  const picked = selection.value;
  return picked?.kind === "line"
    ? { line: picked.index, ...growthOf(results.value, picked.index) }
    : { line: null, before: 0, after: 0 };
}

function pickedGroup(): { lines: number; facets: number[] } {
  const picked = selection.value;
  return picked?.kind === "group" ? groupParts(results.value, picked.index) : { lines: 0, facets: [] };
}

function pickedDensePlane(): DensePlaneParts | null {
  const picked = selection.value;
  return picked?.kind === "dense" ? densePlaneParts(results.value, picked.index) : null;
}

function pickedSet(): CoplanarSetParts | null {
  const picked = selection.value;
  return picked?.kind === "coplanar" ? coplanarSetParts(results.value, picked.index) : null;
}

function pickedCorner(): CornerParts | null {
  const picked = selection.value;
  return picked?.kind === "corner" ? cornerParts(results.value, picked.index) : null;
}

function denseWords({ patches, rmsM, facets }: DensePlaneParts): string {
  return `${counted(patches, "patches")}, each matched on its own, lie within ${(100 * rmsM).toFixed(0)} cm (RMS) of one plane: that of facet ${facets.join(", ")}.`;
}

function halfPlaneWords({ halfPlanes }: DensePlaneParts): string {
  return halfPlanes === 0
    ? "No half-plane found it."
    : `From lines, ${counted(halfPlanes, "half-planes")} found it, too: two ways, one plane.`;
}

/** In how many views the picked line shows. */
function pickedViews(): number {
  const picked = selection.value;
  return picked?.kind === "line" ? (results.value.records[picked.index]?.supports.length ?? 0) : 0;
}

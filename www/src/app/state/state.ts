/** All that the page knows, as signals. Components read them; `core.ts`, `running.ts` and `projectActions.ts` alone write what the worker says. */
import { computed, signal } from "@preact/signals";
import { automaticWorkers } from "../../core/workerCount";
import type { InputFile } from "../../shared/messages";
import type { DoctorReport, Facet, HalfPlane, Inspection, Params, SceneInfo } from "../../shared/results";
import type { Selection } from "../../shared/selection";
import type * as traces from "../../shared/traces";

const LINE_TABS = ["segments", "matches", "lines", "halfplanes", "groups", "facets", "refinement"] as const;
const REGION_TABS = ["regions", "directions", "clusters", "rectangles"] as const;

/** The stage views of each method. */
export const TABS = {
  lines: ["images", ...LINE_TABS, "model"],
  rectangles: ["images", ...REGION_TABS, "model"],
  combined: ["images", ...REGION_TABS, ...LINE_TABS, "model"],
} as const;
export type Method = keyof typeof TABS;
export type Tab = (typeof TABS)[Method][number];

export type StageStatus = "waiting" | "running" | "done" | "outdated" | "failed";

export interface StageState {
  name: string;
  status: StageStatus;
  /** 0 to 1 while running. */
  fraction: number;
  seconds: number | null;
  counts: Record<string, number>;
  warnings: string[];
}

export interface Notice {
  id: number;
  severity: "error" | "warning" | "info";
  title: string;
  text: string;
  /** What to do about it. */
  advice?: string;
  /** What the images say of the orientation. */
  doctor?: DoctorReport;
  /** Something that can be done about it. */
  action?: { name: string; run: () => void };
}

/** What the stages have returned so far; arrays per view are empty until their stage has run. */
export interface Results {
  segments: Float32Array[];
  supports: Float32Array[];
  lines: Float64Array | null;
  halfPlanes: HalfPlane[] | null;
  facets: Facet[] | null;
  /** The parameters that the facets were found with. */
  madeWith: Params | null;
  glb: Uint8Array<ArrayBuffer> | null;
  rejected: Float32Array[];
  matching: traces.MatchRecord | null;
  records: traces.LineRecord[];
  stretches: Float64Array | null;
  sides: traces.SideRecord[];
  grouping: traces.Grouping | null;
  refinement: traces.Refinement | null;
  regions: traces.Segmentation[];
  directions: traces.Directions | null;
  clusters: traces.ClusterTrace[] | null;
  rectangles: traces.RectangleTrace | null;
}

/** What the reader points at in a figure, and what the core answered. */
export interface Pointing {
  /** The story of the selected segment. */
  story: traces.SegmentStory | null;
  /** The candidate that is compared with it, by its place in the story. */
  candidate: number;
  /** Where on the segment the point is, 0 to 1. */
  at: number;
  /** Whether the reader moved it. */
  isMoved: boolean;
  correspondence: traces.Correspondence | null;
  /** The side of the selected line or half-plane, its Sim(theta), and the angle that is tried, radians. */
  side: traces.SideTrace | null;
  theta: number;
  /** Whether the reader turned it. */
  isTurned: boolean;
  warped: traces.WarpedPicture | null;
}

export const NO_RESULTS: Results = {
  segments: [],
  supports: [],
  lines: null,
  halfPlanes: null,
  facets: null,
  madeWith: null,
  glb: null,
  rejected: [],
  matching: null,
  records: [],
  stretches: null,
  sides: [],
  grouping: null,
  refinement: null,
  regions: [],
  directions: null,
  clusters: null,
  rectangles: null,
};

export const NOTHING_POINTED: Pointing = {
  story: null,
  candidate: 0,
  at: 0.5,
  isMoved: false,
  correspondence: null,
  side: null,
  theta: 0,
  isTurned: false,
  warped: null,
};

export const files = signal<InputFile[]>([]);
/** Whether the project is the demo scene as it was fetched: a link may name that. */
export const isDemo = signal(false);
export const projectName = signal("");
/** What the person asked for beyond the files; images are left out by their path. */
export interface RunOptions {
  orientation: string | null;
  leftOut: readonly string[];
  roi: [number, number, number, number] | null;
  groundZ: number | null;
  /** Undo the mistake in the orientation that the images give away. */
  applyFix: boolean;
  /** Adjust small errors of single views. */
  adjust: boolean;
  /** Size of the tiles in which the region is worked off, metres; null: in one. */
  tileM: number | null;
  /** As a project file says. */
  epsg: number | null;
}

export const NO_OPTIONS: RunOptions = {
  orientation: null,
  leftOut: [],
  roi: null,
  groundZ: null,
  applyFix: false,
  adjust: false,
  tileM: null,
  epsg: null,
};

export const runOptions = signal<RunOptions>(NO_OPTIONS);
export const inspection = signal<Inspection | null>(null);
/** Memory that the views in use will take at most, megabytes; null until they are read. */
export const peakMb = signal<number | null>(null);
export const scene = signal<SceneInfo | null>(null);
/** The undistorted images of the loaded scene, by view. */
export const images = signal<ImageBitmap[]>([]);

export const defaults = signal<Params>({});
export const params = signal<Params>({});

export const method = computed<Method>(() => methodOf(params.value));

export function methodOf(values: Params): Method {
  return methodNamed(values["method"]) ?? "lines";
}

/** The method of this name; null where there is none. */
export function methodNamed(name: unknown): Method | null {
  return (Object.keys(TABS) as Method[]).find((one) => one === name) ?? null;
}

/** How many workers the person wants; 0: as many as are of use. */
export const chosenWorkers = signal(0);
export const usefulWorkers = computed(() => {
  const views = scene.value?.views ?? [];
  const pixels = views.reduce((sum, { width, height }) => sum + width * height, 0);
  return automaticWorkers(navigator.hardwareConcurrency ?? 1, pixels);
});
export const workers = computed(() => chosenWorkers.value || usefulWorkers.value);

export const stages = signal<StageState[]>([]);

/** Where a stage's results are kept: in method "combined" both methods have segments, lines and facets of their own. */
type Keeper = "main" | "regions";
const found = signal<Record<Keeper, Results>>({ main: NO_RESULTS, regions: NO_RESULTS });

/** Of which stages the present tab tells. */
export const shownKeeper = computed<Keeper>(() => keeperOf(tab.value));
/** What the present tab tells of. */
export const results = computed(() => found.value[shownKeeper.value]);
/** What the model is made of. */
export const mainResults = computed(() => found.value.main);

export function setResults(all: Results): void {
  found.value = { main: all, regions: NO_RESULTS };
}

/** Adds what a stage has found that `shownBy` shows. */
export function addResults(shownBy: Tab, some: Partial<Results>): void {
  const keeper = keeperOf(shownBy);
  found.value = { ...found.value, [keeper]: { ...found.value[keeper], ...some } };
}

function keeperOf(name: Tab): Keeper {
  const names: readonly Tab[] = REGION_TABS;
  return method.value === "combined" && names.includes(name) ? "regions" : "main";
}

export const exportNames = signal<string[]>([]);

export const notices = signal<Notice[]>([]);
/** What a screen reader is told of: the last thing that happened. */
export const announcement = signal("");
/** What the worker is doing besides stages; empty when idle. */
export const activity = signal("");

export const tab = signal<Tab>("images");
/** The view shown in the image tabs; -1: all of them side by side. */
export const shownView = signal(0);
export const selection = signal<Selection | null>(null);
export const pointing = signal<Pointing>(NOTHING_POINTED);
/** Which cluster plane, or histogram, of the rectangles method is shown. */
export const shownPlane = signal(0);
/** Whether the 3D lines are shown as the segments alone gave them (B99 figures 5 and 7). */
export const beforeGrowing = signal(false);
/** Whether the image tabs zoom to what is selected. */
export const followsSelection = signal(true);
/** Whether the refused lines of edgels are drawn too. */
export const withRejected = signal(false);
/** A model that was kept, to compare others with it. */
export interface KeptResult {
  title: string;
  method: Method;
  facets: Facet[];
  /** The textured model; null where it was kept before there was one. */
  glb: Results["glb"];
  lines: number;
  seconds: number;
  params: Params;
}

export const keptResult = signal<KeptResult | null>(null);

/** How large text and lines are: for projectors more than 1. */
export const textScale = signal(1);

/** The step of the guided tour; null while it is closed. */
export const lessonStep = signal<number | null>(null);
/** Bytes that the browser keeps of the project; null when it keeps nothing. */
export const keptBytes = signal<number | null>(null);

/** How many stages, from the first, the worker has run with the present files and parameters. */
export const freshStages = signal(0);

export const runningStage = computed(() => stages.value.find((stage) => stage.status === "running") ?? null);
export const isBusy = computed(() => activity.value !== "" || runningStage.value !== null);

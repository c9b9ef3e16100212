/** All that the page knows, as signals. Components read them; `actions.ts` alone writes what the worker says. */
import { computed, signal } from "@preact/signals";
import type { InputFile } from "../shared/messages";
import type { Facet, HalfPlane, Inspection, Params, SceneInfo } from "../shared/results";
import type { Selection } from "../shared/selection";

export const TABS = ["images", "segments", "matches", "lines", "halfplanes", "facets", "model"] as const;
export type Tab = (typeof TABS)[number];

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
}

/** What the stages have returned so far; arrays per view are empty until their stage has run. */
export interface Results {
  segments: Float32Array[];
  supports: Float32Array[];
  lines: Float64Array | null;
  halfPlanes: HalfPlane[] | null;
  facets: Facet[] | null;
  glb: Uint8Array<ArrayBuffer> | null;
}

export const NO_RESULTS: Results = {
  segments: [],
  supports: [],
  lines: null,
  halfPlanes: null,
  facets: null,
  glb: null,
};

export const files = signal<InputFile[]>([]);
export const projectName = signal("");
/** What the person asked for beyond the files; images are left out by their path. */
export interface RunOptions {
  orientation: string | null;
  leftOut: readonly string[];
  roi: [number, number, number, number] | null;
  groundZ: number | null;
}

export const NO_OPTIONS: RunOptions = { orientation: null, leftOut: [], roi: null, groundZ: null };

export const runOptions = signal<RunOptions>(NO_OPTIONS);
export const inspection = signal<Inspection | null>(null);
export const scene = signal<SceneInfo | null>(null);
/** The undistorted images of the loaded scene, by view. */
export const images = signal<ImageBitmap[]>([]);

export const defaults = signal<Params>({});
export const params = signal<Params>({});

export const stages = signal<StageState[]>([]);
export const results = signal<Results>(NO_RESULTS);
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

/** How many stages, from the first, the worker has run with the present files and parameters. */
export const freshStages = signal(0);

export const runningStage = computed(() => stages.value.find((stage) => stage.status === "running") ?? null);
export const isBusy = computed(() => activity.value !== "" || runningStage.value !== null);

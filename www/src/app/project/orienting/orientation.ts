/** The orientation of photographs alone: how far it is, what was found, and what a person can do about it. */

import { batch, effect, type ReadonlySignal, signal } from "@preact/signals";
import { zipSync } from "fflate";
import { EngineError } from "../../../core/engine";
import { OrientationRun } from "../../../core/orientation";
import type { InputFile } from "../../../shared/calls";
import type {
  LengthMark,
  MeasuredLength,
  OrientationReport,
  OrientedBlock,
  PairSummary,
  PhotoFeatures,
} from "../../../shared/orientation";
import { counted } from "../../parts/counted";
import { saveFile } from "../../parts/saveFile";
import { actions } from "../../session/session";
import { runEverything } from "../../session/stageRuns";
import { announce } from "../../state/notices";
import { files, inspection, replaceRunOptions, runOptions } from "../../state/project";
import { addFilesIn } from "../projectActions";

/** What is being done, in order. */
export const STEPS = ["keypoints", "matches", "pairs", "registration", "done"] as const;
export type Step = (typeof STEPS)[number];

interface Progress {
  step: Step;
  /** Of the step. */
  fraction: number;
  /** Photographs to orient. */
  photographs: number;
}

/** Matches of a pair, by its place among the pairs. */
export interface ShownPair {
  place: number;
  /** x, y in the first and x, y in the second photograph, pixels. */
  matches: Float32Array;
}

const present = {
  progress: signal<Progress | null>(null),
  read: signal<readonly PhotoFeatures[]>([]),
  pairs: signal<readonly PairSummary[]>([]),
  shownPair: signal<ShownPair | null>(null),
  block: signal<OrientedBlock | null>(null),
  report: signal<OrientationReport | null>(null),
  focalPx: signal<number | null>(null),
};

/** Null while nothing was begun. */
export const progress: ReadonlySignal<Progress | null> = present.progress;
export const readPhotographs: ReadonlySignal<readonly PhotoFeatures[]> = present.read;
export const pairs: ReadonlySignal<readonly PairSummary[]> = present.pairs;
export const shownPair: ReadonlySignal<ShownPair | null> = present.shownPair;
export const block: ReadonlySignal<OrientedBlock | null> = present.block;
export const report: ReadonlySignal<OrientationReport | null> = present.report;

/** Focal length of all photographs, pixels, where a person states it. */
export const statedFocalPx: ReadonlySignal<number | null> = present.focalPx;

export function stateFocal(px: number | null): void {
  present.focalPx.value = px;
}

let run: OrientationRun | null = null;

function reset(): void {
  run?.close();
  run = null;
  batch(() => {
    present.progress.value = null;
    present.read.value = [];
    present.pairs.value = [];
    present.shownPair.value = null;
    present.block.value = null;
    present.report.value = null;
  });
}

// What was found of other files is of no more use.
effect(() => {
  void files.value;
  reset();
});

/** More hold more photographs in memory than they save time. */
const MOST_WORKERS = 4;

function workersFor(cores: number): number {
  return Math.max(1, Math.min(cores <= 2 ? cores : cores - 1, MOST_WORKERS));
}

/** Computes the orientation of the project's photographs; with the fix lists and headers are read as they were meant. */
export async function computeOrientation(appliesFix = false): Promise<void> {
  await actions.perform({ kind: "run", name: "orientation", phase: "run" }, async ({ signal: end }) => {
    reset();
    end.addEventListener("abort", reset);
    const paths = new Set(inspection.value?.images.map(({ path }) => path));
    const photographs = files.value.filter(({ path }) => paths.has(path));
    const lists = LISTS.flatMap((name) => files.value.find(({ path }) => name.test(path)) ?? []);
    const started = new OrientationRun();
    run = started;
    try {
      await orientIn(started, photographs, lists, appliesFix);
    } catch (error) {
      // What ended it may be another run already.
      if (run === started) {
        reset();
      }
      throw error;
    }
  });
}

/** Lists of ground control points and of the photographs' own places, as OpenDroneMap's. */
const LISTS = [/(?:^|\/)gcp_list\.txt$/i, /(?:^|\/)geo\.txt$/i];

async function orientIn(
  started: OrientationRun,
  photographs: readonly InputFile[],
  lists: readonly InputFile[],
  appliesFix: boolean,
): Promise<void> {
  const reach = (step: Step, fraction: number) => {
    present.progress.value = { step, fraction, photographs: photographs.length };
  };
  reach("keypoints", 0);
  const options = { ...(statedFocalPx.value !== null && { focalPx: statedFocalPx.value }), appliesFix };
  const workers = workersFor(navigator.hardwareConcurrency ?? 1);
  const found = await started.orient(photographs, lists, workers, options, {
    onPhoto: (photograph, done) => {
      present.read.value = [...present.read.value, photograph];
      reach("keypoints", done / photographs.length);
    },
    onPairing: (fraction) => {
      const step = fraction < MATCHED_AT ? "matches" : "pairs";
      const [from, to] = step === "matches" ? [0, MATCHED_AT] : [MATCHED_AT, 1];
      reach(step, Math.max(0, (fraction - from) / (to - from)));
    },
    onPairs: (connected, matches) => {
      present.pairs.value = connected;
      present.shownPair.value = { place: 0, matches };
      reach("registration", 0);
    },
    onRegistering: (fraction) => reach("registration", fraction),
    onBlock: (grown) => {
      present.block.value = grown;
    },
  });
  const whole = await started.ask("block");
  batch(() => {
    present.block.value = whole;
    present.report.value = found;
    reach("done", 1);
  });
  announce(`Oriented: ${found.photos.length} of ${counted(photographs.length, "photographs")}.`);
}

/** Share of the work on pairs after which their keypoints are matched. */
const MATCHED_AT = 2 / 3;

/** Asks what was found; null where that has been replaced since. */
async function answered<T>(asked: (of: OrientationRun) => Promise<T>): Promise<T | null> {
  try {
    return run === null ? null : await asked(run);
  } catch (error) {
    if (error instanceof EngineError && error.kind === "cancelled") {
      return null;
    }
    throw error;
  }
}

/** Shows the matches of another pair. */
export async function showPair(place: number): Promise<void> {
  const matches = await answered((of) => of.ask("pairMatches", place));
  if (matches !== null) {
    present.shownPair.value = { place, matches };
  }
}

/** The image in the second photograph of the ray through a pixel of the first: x, y of points along it. */
export function epipolarCurve(
  first: string,
  second: string,
  x: number,
  y: number,
): Promise<Float32Array | null> {
  return answered((of) => of.ask("epipolarCurve", first, second, x, y));
}

/** The length between two places that are marked in photographs; or why there is none, in words. */
export function measureLength(ends: [LengthMark[], LengthMark[]]): Promise<MeasuredLength | string | null> {
  return answered((of) => of.ask("measureLength", ends));
}

/** Sets the scale: what measures `measured` now becomes `metres`. */
export async function setScale(measured: number, metres: number, words: string): Promise<void> {
  const found = await answered((of) => of.ask("setLength", measured, metres, words));
  const whole = found === null ? null : await answered((of) => of.ask("block"));
  if (found !== null && whole !== null) {
    batch(() => {
      present.report.value = found;
      present.block.value = whole;
    });
  }
}

/** The files of the orientation: COLMAP's text model, and the report. */
async function orientationFiles(): Promise<InputFile[]> {
  const names = (await answered((of) => of.ask("exportNames"))) ?? [];
  const written: InputFile[] = [];
  for (const name of names) {
    const bytes = await answered((of) => of.ask("exportFile", name));
    if (bytes !== null) {
      written.push({ path: name, blob: new Blob([bytes], { type: "text/plain" }) });
    }
  }
  return written;
}

/** Saves one of the files. */
export async function saveOrientation(name: string): Promise<void> {
  const found = (await orientationFiles()).find(({ path }) => path === name);
  if (found !== undefined) {
    saveFile(name, found.blob);
  }
}

/** Saves all of them as one archive. */
export async function saveOrientationFiles(): Promise<void> {
  const written = await orientationFiles();
  if (written.length > 0) {
    saveFile("orientation.zip", await zipped(written));
  }
}

/** Of these the project is made: the report says where on the Earth it is and what its scale is worth; the log is for people. */
const ADDED = /^(?:(?:cameras|images|points3D)\.txt|orientation\.json)$/;

/** Adds the orientation to the project, as if it had been dropped, and reconstructs. */
export async function reconstructWithIt(): Promise<void> {
  const written = await orientationFiles();
  const added = written
    .filter(({ path }) => ADDED.test(path))
    .map(({ path, blob }) => ({ path: `orientation/${path}`, blob }));
  if (added.length === 0) {
    return;
  }
  const action = { kind: "change", name: "orientation", phase: "load", words: "Reading files" } as const;
  const epsg = report.value?.epsg ?? null;
  await actions.perform(action, async (turn) => {
    if (epsg !== null) {
      replaceRunOptions({ ...runOptions.value, epsg });
    }
    await addFilesIn(turn, added);
    await runEverything(turn);
  });
}

/** Where the format's time begins, so that the same files give the same bytes. */
const NO_TIME = new Date(1980, 0, 1);

/** Files in one archive. */
async function zipped(files: readonly InputFile[]): Promise<Blob> {
  const read = async ({ path, blob }: InputFile) => [path, new Uint8Array(await blob.arrayBuffer())] as const;
  const entries = Object.fromEntries(await Promise.all(files.map(read)));
  return new Blob([zipSync(entries, { mtime: NO_TIME })], { type: "application/zip" });
}

/** The project: its files, what they were recognised as, and what is asked for beyond them. */
import { batch, computed, type ReadonlySignal, signal } from "@preact/signals";
import type { InputFile } from "../../shared/calls";
import type { ParamTree } from "../../shared/paramTree";
import type { FileKind, Inspection } from "../../shared/records";
import { STAGES_WITHOUT_VIEWS } from "../../shared/stages";
import { stagesOf } from "../../stages/catalogue";
import { method, params } from "./parameters";

/** What the person asked for beyond the files; images, terrain models and footprints are left out by their path. */
export interface RunOptions {
  orientation: string | null;
  leftOut: readonly string[];
  roi: [number, number, number, number] | null;
  /** The files that are meant where there are several; null: the only one. */
  terrain: string | null;
  footprints: string | null;
  groundZ: number | null;
  /** Undo the mistake in the orientation that the images give away. */
  applyFix: boolean;
  /** Go on where the images do not agree with their orientation. */
  ignoreCheck: boolean;
  /** Size of the tiles in which the region is worked off, metres; null: in one. */
  tileM: number | null;
  /** Every photograph is loaded at once, however many there are. */
  isAtOnce: boolean;
  /** So many by so many pixels of a photograph become one; null: as few as the memory takes. */
  reduction: number | null;
  /** The code of the reference system; null: as the files say. */
  epsg: number | null;
}

export const NO_OPTIONS: RunOptions = {
  orientation: null,
  leftOut: [],
  roi: null,
  terrain: null,
  footprints: null,
  groundZ: null,
  applyFix: false,
  ignoreCheck: false,
  tileM: null,
  isAtOnce: false,
  reduction: null,
  epsg: null,
};

/** All that a person has put into the project, and by which it is told from others. */
export interface ProjectState {
  /** When it was begun: two may have one name. */
  id: number;
  name: string;
  isDemo: boolean;
  files: InputFile[];
  options: RunOptions;
  params: ParamTree;
}

const present = {
  id: signal(0),
  files: signal<InputFile[]>([]),
  isDemo: signal(false),
  name: signal(""),
  options: signal<RunOptions>(NO_OPTIONS),
  inspection: signal<Inspection | null>(null),
};

export const files: ReadonlySignal<InputFile[]> = present.files;
/** Whether the project is the demo scene as it was fetched: a link may name that. */
export const isDemo: ReadonlySignal<boolean> = present.isDemo;
export const projectName: ReadonlySignal<string> = present.name;
export const runOptions: ReadonlySignal<RunOptions> = present.options;
export const inspection: ReadonlySignal<Inspection | null> = present.inspection;

/** Whether there are photographs, none of them oriented, and nothing that was meant to orient them. */
export const hasPhotographsOnly = computed(() => {
  const { files: known, images } = inspection.value ?? { files: [], images: [] };
  const isHelpless = known.every(({ kind }) => kind === "image" || kind === "ignored");
  return isHelpless && images.length > 0 && images.every(({ orientation }) => orientation === null);
});

/** Whether the project is a model that is there already, and no photographs. */
export const isModelOnly = computed(() => inspection.value?.model != null);

/** The stages of the project, in their order. */
export const projectStages = computed(() =>
  isModelOnly.value ? STAGES_WITHOUT_VIEWS : stagesOf(method.value),
);

/** Terrain models and footprints: what is known of the place beforehand. */
export type KnownKind = Extract<FileKind, "terrain" | "footprints">;

export function isKnownKind(kind: FileKind): kind is KnownKind {
  return kind === "terrain" || kind === "footprints";
}

/** Other files: nothing is known of them yet, and without any nothing is asked for. */
export function replaceFiles(next: InputFile[]): void {
  batch(() => {
    present.files.value = next;
    present.isDemo.value = false;
    present.inspection.value = null;
    if (next.length === 0) {
      present.options.value = NO_OPTIONS;
    }
  });
}

export function markAsDemo(isDemo: boolean): void {
  present.isDemo.value = isDemo;
}

/** Another project than before begins, or is taken up again. */
export function nameProject(name: string, id = Date.now()): void {
  batch(() => {
    present.name.value = name;
    present.id.value = id;
  });
}

export function presentProject(): ProjectState {
  return {
    id: present.id.value,
    name: present.name.value,
    isDemo: present.isDemo.value,
    files: present.files.value,
    options: present.options.value,
    params: params.value,
  };
}

export function replaceRunOptions(options: RunOptions): void {
  present.options.value = options;
}

export function setInspection(found: Inspection | null): void {
  present.inspection.value = found;
}

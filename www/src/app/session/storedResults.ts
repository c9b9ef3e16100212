/** The results as they are kept with the project: shown again without a run, where the same core found them. */
import { batch } from "@preact/signals";
import { CORE_VERSION } from "../../core/engine";
import type { ParamTree } from "../../shared/paramTree";
import type { SceneInfo } from "../../shared/records";
import { changedParams } from "../settings/parameterForm";
import { defaults, params } from "../state/parameters";
import {
  allResults,
  exportNames,
  NO_RESULTS,
  type ResultSets,
  restoreResults,
  setExportNames,
} from "../state/results";
import { scene, setScene } from "../state/scene";
import { outdateStages, restoreStages, type StageState, stages } from "../state/stages";

export interface StoredResults {
  /** Of which core: another one may find something else. */
  core: string;
  params: ParamTree;
  results: ResultSets;
  /** As the results have them: some may be adjusted. */
  views: SceneInfo["views"];
  stages: StageState[];
  exportNames: string[];
}

/** What there is to keep; null before the first stage has run. */
export function presentResults(): StoredResults | null {
  if (!stages.value.some(({ status }) => status === "done" || status === "outdated")) {
    return null;
  }
  return {
    core: CORE_VERSION,
    params: params.value,
    results: allResults.value,
    views: scene.value?.views ?? [],
    stages: stages.value,
    exportNames: exportNames.value,
  };
}

/** Shows what was kept; not where another core, or another method, found it. */
export function showStoredResults(kept: StoredResults): void {
  const names = (all: readonly StageState[]) => all.map(({ name }) => name).join();
  if (kept.core !== CORE_VERSION || names(kept.stages) !== names(stages.value)) {
    return;
  }
  batch(() => {
    restoreResults(kept.results);
    if (scene.value !== null && kept.views.length === scene.value.views.length) {
      setScene({ ...scene.value, views: kept.views });
    }
    restoreStages(kept.stages);
    setExportNames(kept.exportNames);
    if (changesOf(kept.params) !== changesOf()) {
      outdateStages(0);
    }
  });
}

/**
 * What was found before files or wishes changed stays in view, outdated: all of it where the views are the same ones, else
 * what does not count them.
 */
export function showOutdated(kept: StoredResults | null): void {
  if (kept === null || scene.value === null) {
    return;
  }
  const named = (views: SceneInfo["views"]) => views.map(({ name }) => name).join("/");
  if (named(kept.views) === named(scene.value.views)) {
    showStoredResults(kept);
  } else {
    const { facets, glb, ground, uncovered } = kept.results.main;
    const main = { ...NO_RESULTS, facets, glb, ground, uncovered };
    showStoredResults({ ...kept, views: [], results: { main, regions: NO_RESULTS } });
  }
  outdateStages(0);
}

/** In what parameters differ from the defaults, whatever the order of their names. */
export function changesOf(values = params.value): string {
  return JSON.stringify(Object.entries(changedParams(defaults.value, values)).sort());
}

/** As bytes, for a project file: JSON, with arrays of numbers as base64. */
export function packResults(kept: StoredResults): Uint8Array<ArrayBuffer> {
  const text = JSON.stringify(kept, (_, value: unknown) => {
    const kind = KINDS.find(({ of }) => value instanceof of);
    return kind === undefined ? value : { [kind.name]: toBase64(value as ArrayBufferView) };
  });
  return new TextEncoder().encode(text);
}

/** From bytes; null where they are not what `packResults` writes. */
export function unpackResults(bytes: Uint8Array): StoredResults | null {
  try {
    const read: unknown = JSON.parse(new TextDecoder().decode(bytes), (_, value: unknown) => {
      const kind = KINDS.find(({ name }) => typeof value === "object" && value !== null && name in value);
      return kind === undefined ? value : kind.make(fromBase64((value as Record<string, string>)[kind.name]));
    });
    const isOurs = typeof read === "object" && read !== null && "core" in read && "results" in read;
    return isOurs ? (read as StoredResults) : null;
  } catch {
    return null;
  }
}

const KINDS = [
  { name: "$float32", of: Float32Array, make: (from: ArrayBuffer) => new Float32Array(from) },
  { name: "$float64", of: Float64Array, make: (from: ArrayBuffer) => new Float64Array(from) },
  { name: "$bytes", of: Uint8Array, make: (from: ArrayBuffer) => new Uint8Array(from) },
] as const;

function toBase64({ buffer, byteOffset, byteLength }: ArrayBufferView): string {
  const bytes = new Uint8Array(buffer, byteOffset, byteLength);
  let text = "";
  // As many at a time as a call takes arguments.
  for (let at = 0; at < bytes.length; at += 0x8000) {
    text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  }
  return btoa(text);
}

function fromBase64(text = ""): ArrayBuffer {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
}

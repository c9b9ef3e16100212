/** What a stage adds to the results. */
import type { Args, Result } from "../../shared/calls";
import type { StageName } from "../../shared/stages";
import { params } from "../state/parameters";
import type { Results } from "../state/results";
import { scene } from "../state/scene";
import { engine } from "./session";

/** What the page asks the core for, once a stage has run. */
const FETCHED: Record<StageName, () => Promise<Partial<Results>>> = {
  regions: async () => ({
    segments: await perView("segments"),
    regions: (await perView("regions")).filter(isPresent),
  }),
  directions: async () => ({ directions: await engine.call("directions") }),
  clusters: async () => ({ ...(await fetchLines()), clusters: await engine.call("clusters") }),
  rectangles: async () => ({
    facets: await engine.call("facets"),
    madeWith: params.value,
    rectangles: await engine.call("rectangles"),
  }),
  segments: async () => ({
    segments: await perView("segments"),
    rejected: await perView("rejectedSegments"),
  }),
  matches: async () => ({
    supports: await perView("matchedSegments"),
    matching: await engine.call("matching"),
  }),
  // Where views moved, `followCameras` shows it.
  adjustment: async () => ({}),
  lines: async () => ({
    ...(await fetchLines()),
    stretches: await engine.call("detectedStretches"),
  }),
  halfplanes: async () => ({
    halfPlanes: await engine.call("halfPlanes"),
    sides: await engine.call("sides"),
  }),
  coplanar: async () => ({ coplanar: await engine.call("coplanar") }),
  adjacency: async () => ({ adjacency: await engine.call("adjacency") }),
  dense: async () => ({ dense: await engine.call("dense") }),
  facets: async () => ({
    facets: await engine.call("facets"),
    madeWith: params.value,
    grouping: await engine.call("grouping"),
    refinement: await engine.call("refinement"),
    // The model adds new lines to the matched ones.
    ...(await fetchLines()),
  }),
  model: async () => ({
    glb: await engine.call("exportFile", "model.glb"),
    ground: await engine.call("ground"),
  }),
};

/** What a stage adds to the results. */
export function fetchResults(stage: StageName): Promise<Partial<Results>> {
  return FETCHED[stage]();
}

async function fetchLines(): Promise<Partial<Results>> {
  return {
    supports: await perView("matchedSegments"),
    lines: await engine.call("lines"),
    records: await engine.call("lineRecords"),
  };
}

/** The answers for all views. */
function perView<K extends "segments" | "matchedSegments" | "rejectedSegments" | "regions">(
  call: K,
): Promise<Result<K>[]> {
  const views = scene.value?.views ?? [];
  return Promise.all(views.map((_, view) => engine.call(call, ...([view] as Args<K>))));
}

function isPresent<T>(value: T | null): value is T {
  return value !== null;
}

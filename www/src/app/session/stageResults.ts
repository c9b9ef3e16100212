/** What a stage adds to the results. */
import type { Args, CallName, Result } from "../../shared/calls";
import type { ParamTree } from "../../shared/paramTree";
import type { StageName } from "../../shared/stages";
import type { Results } from "../../stages/figure";

/** Who answers, and of what. */
export interface ResultSource {
  call<K extends CallName>(name: K, ...args: Args<K>): Promise<Result<K>>;
  /** How many views the scene has. */
  views: number;
  /** What the stage ran with. */
  params: ParamTree;
}

/** What is asked of the core, once a stage has run. */
const FETCHED: Record<StageName, (from: ResultSource) => Promise<Partial<Results>>> = {
  regions: async (from) => ({
    segments: await perView(from, "segments"),
    regions: (await perView(from, "regions")).filter(isPresent),
  }),
  directions: async (from) => ({ directions: await from.call("directions") }),
  clusters: async (from) => ({ ...(await fetchLines(from)), clusters: await from.call("clusters") }),
  rectangles: async (from) => ({
    facets: await from.call("facets"),
    corrected: null,
    madeWith: from.params,
    rectangles: await from.call("rectangles"),
  }),
  segments: async (from) => ({
    segments: await perView(from, "segments"),
    rejected: await perView(from, "rejectedSegments"),
  }),
  matches: async (from) => ({
    supports: await perView(from, "matchedSegments"),
    matching: await from.call("matching"),
  }),
  // Where views moved, `followCameras` shows it.
  adjustment: async () => ({}),
  lines: async (from) => ({
    ...(await fetchLines(from)),
    stretches: await from.call("detectedStretches"),
  }),
  halfplanes: async (from) => ({
    halfPlanes: await from.call("halfPlanes"),
    sides: await from.call("sides"),
    terrain: await from.call("terrain"),
  }),
  coplanar: async (from) => ({ coplanar: await from.call("coplanar") }),
  adjacency: async (from) => ({ adjacency: await from.call("adjacency") }),
  dense: async (from) => ({ dense: await from.call("dense") }),
  groups: async (from) => ({ grouping: await from.call("grouping") }),
  facets: async (from) => ({
    facets: await from.call("facets"),
    corrected: null,
    madeWith: from.params,
    verification: await from.call("verification"),
    // Of other facets.
    refinement: null,
  }),
  refinement: async (from) => ({
    facets: await from.call("facets"),
    corrected: null,
    madeWith: from.params,
    refinement: await from.call("refinement"),
    // The model adds new lines to the matched ones.
    ...(await fetchLines(from)),
  }),
  corrections: async (from) => ({
    facets: await from.call("facets"),
    corrected: await from.call("corrected"),
  }),
  model: async (from) => ({
    glb: await from.call("exportFile", "model.glb"),
    ground: await from.call("ground"),
  }),
};

/** What a stage adds to the results. */
export function fetchResults(stage: StageName, from: ResultSource): Promise<Partial<Results>> {
  return FETCHED[stage](from);
}

async function fetchLines(from: ResultSource): Promise<Partial<Results>> {
  return {
    supports: await perView(from, "matchedSegments"),
    lines: await from.call("lines"),
    records: await from.call("lineRecords"),
  };
}

/** The answers for all views. */
function perView<K extends "segments" | "matchedSegments" | "rejectedSegments" | "regions">(
  from: ResultSource,
  call: K,
): Promise<Result<K>[]> {
  const views = Array.from({ length: from.views }, (_, view) => view);
  return Promise.all(views.map((view) => from.call(call, ...([view] as Args<K>))));
}

function isPresent<T>(value: T | null): value is T {
  return value !== null;
}

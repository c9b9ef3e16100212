/** What a stage adds to the results. */
import type { Queries } from "../../shared/messages";
import { params } from "../state/parameters";
import type { Results } from "../state/results";
import { scene } from "../state/scene";
import { engine } from "./session";

/** What a stage adds to the results. */
export async function fetchResults(stage: string): Promise<Partial<Results>> {
  switch (stage) {
    case "segments":
      return { segments: await perView("segments"), rejected: await askViews("rejectedSegments") };
    case "matches":
      return { supports: await perView("matchedSegments"), matching: await engine.ask("matching") };
    case "lines":
      return {
        ...(await fetchLines()),
        stretches: await engine.ask("detectedStretches"),
      };
    case "halfplanes":
      return { halfPlanes: await engine.call("halfPlanes", {}), sides: await engine.ask("sides") };
    case "facets":
      return {
        facets: await engine.call("facets", {}),
        madeWith: params.value,
        grouping: await engine.ask("grouping"),
        refinement: await engine.ask("refinement"),
        // The model adds new lines to the matched ones.
        ...(await fetchLines()),
      };
    case "regions":
      return { segments: await perView("segments"), regions: (await askViews("regions")).filter(isPresent) };
    case "directions":
      return { directions: await engine.ask("directions") };
    case "clusters":
      return { ...(await fetchLines()), clusters: await engine.ask("clusters") };
    case "rectangles":
      return {
        facets: await engine.call("facets", {}),
        madeWith: params.value,
        rectangles: await engine.ask("rectangles"),
      };
    case "model":
      return { glb: await engine.call("exportFile", { name: "model.glb" }) };
    default:
      return {};
  }
}

async function fetchLines(): Promise<Partial<Results>> {
  return {
    supports: await perView("matchedSegments"),
    lines: await engine.call("lines", {}),
    records: await engine.ask("lineRecords"),
  };
}

/** The answers for all views. */
function askViews<K extends "rejectedSegments" | "regions">(query: K): Promise<Queries[K]["result"][]> {
  const views = scene.value?.views ?? [];
  return Promise.all(views.map((_, view) => engine.ask(query, view)));
}

function isPresent<T>(value: T | null): value is T {
  return value !== null;
}

function perView(call: "segments" | "matchedSegments"): Promise<Float32Array[]> {
  const views = scene.value?.views ?? [];
  return Promise.all(views.map((_, view) => engine.call(call, { view })));
}

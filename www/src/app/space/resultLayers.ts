/** The layers of the 3D view, from the results: each is built anew when what it shows has changed, in a task of its own. */
import { effect, type ReadonlySignal, signal } from "@preact/signals";
import { Vector3 } from "three";
import { linesOf, shapesOf } from "../../kinds/kinds";
import { lineEnds } from "../../kinds/parts/shapes";
import { LINE_STRIDE } from "../../shared/flatArrays";
import type { Facet, GroupingTrace, Vec3 } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { buildAdjacency } from "../../viewer/layers/adjacency";
import { buildCameras } from "../../viewer/layers/cameras";
import { buildCoplanar } from "../../viewer/layers/coplanar";
import { buildDense } from "../../viewer/layers/dense";
import { buildFacets } from "../../viewer/layers/facets";
import { buildFans, buildTurning } from "../../viewer/layers/fans";
import { buildGround } from "../../viewer/layers/ground";
import { buildGroups } from "../../viewer/layers/groups";
import { buildHighlight } from "../../viewer/layers/highlight";
import { buildLines } from "../../viewer/layers/lines";
import { buildOutlines } from "../../viewer/layers/outlines";
import { buildRefinement } from "../../viewer/layers/refinement";
import { buildStretches } from "../../viewer/layers/stretches";
import { buildUncertainty, enlargement } from "../../viewer/layers/uncertainty";
import { type Layer, unpicked } from "../../viewer/scene/layer";
import type { Viewer } from "../../viewer/viewer";
import { keptResult } from "../state/keptResult";
import type { Tab } from "../state/methods";
import { preliminaryFacets, results } from "../state/results";
import { images, scene } from "../state/scene";
import { selectionDetail } from "../state/selectionDetail";
import { selection, tab } from "../state/viewState";
import { isBeside } from "./keptBeside";
import { modelMode } from "./ModelModes";

/** Layers that a person switches; "stretches" and "turning" follow other switches. */
export const LAYERS = [
  "lines",
  "uncertainty",
  "fans",
  "coplanar",
  "adjacency",
  "dense",
  "groups",
  "facets",
  "model",
  "ground",
  "cameras",
] as const;
export type LayerName = (typeof LAYERS)[number];

/** What each tab shows until a person switches something. */
const chosen = signal<Record<Tab, readonly LayerName[]>>({
  images: [],
  segments: [],
  matches: [],
  lines: ["lines"],
  halfplanes: ["lines", "fans"],
  coplanar: ["coplanar"],
  adjacency: ["adjacency"],
  dense: ["dense"],
  groups: ["groups"],
  facets: ["facets"],
  refinement: ["facets"],
  regions: [],
  directions: [],
  clusters: [],
  rectangles: ["facets", "lines"],
  model: ["model", "ground"],
});
export const shownLayers: ReadonlySignal<Record<Tab, readonly LayerName[]>> = chosen;

/** Shows a layer in a tab, or hides it there. */
export function toggleLayer(name: LayerName, inTab: Tab): void {
  const visible = chosen.value[inTab];
  const next = visible.includes(name) ? visible.filter((one) => one !== name) : [...visible, name];
  chosen.value = { ...chosen.value, [inTab]: next };
}

/** A function that makes a layer, and what it makes it of; null where there is nothing to show. */
type Plan = readonly [build: () => Layer, ...of: unknown[]] | null;

/** The 3D lines of a selection, in the results of now. */
const ownLines = (picked: Selection | null) => linesOf(picked, results.peek());

/** What every layer shows now. `middle` is where cameras look at, local frame. */
const PLANS: Record<string, (middle: () => Vec3) => Plan> = {
  lines: () => {
    const { lines, records } = results.value;
    return lines && [() => buildLines(lines, records, ownLines), lines, records];
  },
  uncertainty: () => {
    const { lines, records } = results.value;
    // Thousands of tubes that few look at: not before somebody does.
    const isShown = shownLayers.value[tab.value].includes("uncertainty");
    const has = isShown && lines !== null && records.length * LINE_STRIDE === lines.length;
    return has ? [() => buildUncertainty(lines, records, enlargement(records), ownLines), records] : null;
  },
  fans: () => {
    const { lines, halfPlanes, sides } = results.value;
    const has = lines !== null && halfPlanes !== null;
    return has ? [() => buildFans(halfPlanes, lines, sides), halfPlanes, lines] : null;
  },
  coplanar: () => {
    const { lines, coplanar } = results.value;
    return lines && coplanar && [() => buildCoplanar(coplanar, lines), coplanar, lines];
  },
  adjacency: () => {
    const { adjacency } = results.value;
    return adjacency && [() => buildAdjacency(adjacency), adjacency];
  },
  dense: () => {
    const { dense } = results.value;
    // Thousands of patches: not before somebody looks.
    const isShown = shownLayers.value[tab.value].includes("dense");
    return isShown && dense !== null ? [() => buildDense(dense), dense] : null;
  },
  groups: () => {
    const { lines, grouping, facets } = results.value;
    const build = () => buildGroups(grouping as GroupingTrace, lines as Float64Array, facets ?? []);
    return lines && grouping && [build, grouping, lines, facets];
  },
  stretches: () => {
    const { stretches } = results.value;
    return stretches && [() => buildStretches(stretches), stretches];
  },
  refinement: () => {
    const { refinement } = results.value;
    return refinement && [() => buildRefinement(refinement), refinement];
  },
  kept: () => {
    const kept = keptResult.value;
    const beside = isBeside.value;
    const build = (facets: readonly Facet[]) =>
      beside ? unpicked(buildFacets(facets)) : buildOutlines(facets);
    return kept && [() => build(kept.facets), kept, beside];
  },
  picked: () => {
    const shapes = shapesOf(selection.value, results.value).filter(({ role }) => role !== "before");
    const all = shapes.map(({ points, role }) => ({ points, closed: role === "area" }));
    return all.length === 0 ? null : [() => buildHighlight(all), selection.value, results.value];
  },
  turning: () => {
    const { side, theta } = selectionDetail.value;
    const ends = side === null ? [] : lineEnds(side.line, results.value);
    return side !== null && ends.length === 2 && tab.value === "halfplanes"
      ? [() => buildTurning(ends as unknown as [Vec3, Vec3], side.side, theta), side, theta]
      : null;
  },
  ground: () => {
    const { ground } = results.value;
    // Beside a model without photographs on it, it would only distract.
    return modelMode.value === "textured" && ground !== null ? [() => buildGround(ground), ground] : null;
  },
  facets: () => {
    const { facets } = results.value;
    return facets && [() => buildFacets(facets), facets];
  },
  preliminary: () => {
    const facets = preliminaryFacets.value;
    return facets && [() => unpicked(buildFacets(facets, false)), facets];
  },
  cameras: (middle) => {
    const views = scene.value?.views;
    // Every photograph is drawn anew: not before somebody looks.
    if (views === undefined || !shownLayers.value[tab.value].includes("cameras")) {
      return null;
    }
    const [x, y, z] = middle();
    const pictures = images.value;
    return [() => buildCameras(views, new Vector3(x, y, z), pictures), views, pictures, x, y, z];
  },
};

/** Keeps the viewer's layers as the results say, until the returned function is called. */
export function followResults(viewer: () => Viewer | null, middle: () => Vec3): () => void {
  const ends = Object.entries(PLANS).map(([name, plan]) => follow(name, viewer, () => plan(middle)));
  return () => {
    for (const end of ends) {
      end();
    }
  };
}

function follow(name: string, viewer: () => Viewer | null, plan: () => Plan): () => void {
  let shown: readonly unknown[] | null = null;
  return effect(() => {
    const space = viewer();
    const next = plan();
    const of = next === null || space === null ? null : [space, ...next.slice(1)];
    if (space === null || isSame(of, shown)) {
      return;
    }
    shown = of;
    setTimeout(() => {
      if (shown === of) {
        const layer = next === null ? null : next[0]();
        layer?.highlight(selection.peek());
        space.setLayer(name, layer);
      }
    });
  });
}

function isSame(a: readonly unknown[] | null, b: readonly unknown[] | null): boolean {
  return a === b || (a !== null && b !== null && a.length === b.length && a.every((one, i) => one === b[i]));
}

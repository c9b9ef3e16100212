/** The items of a kind in their order, so that all can be gone through without a pointer. */
import { LINE_STRIDE, REJECTED_STRIDE, SEGMENT_STRIDE } from "../../shared/flatArrays";
import type { Selection } from "../../shared/selection";
import { formatSelection } from "../../shared/selection";
import type { Tab } from "../../stages/list";
import { results } from "../state/results";
import { scene } from "../state/scene";
import { shownView, tab } from "../state/viewState";

/** The neighbours of the selected thing, or, where nothing is selected, what the present tab is about. */
export function siblingsOf(picked: Selection | null): readonly Selection[] {
  const { rejected, verification, clusters, refinement } = results.value;
  switch (picked?.kind) {
    case undefined:
      return itemsOfTab(tab.value);
    case "segment":
      return segmentsOf(picked.view);
    case "rejectedSegment":
      return numbered((rejected[picked.view]?.length ?? 0) / REJECTED_STRIDE, (index) => ({
        ...picked,
        index,
      }));
    case "line":
      return itemsOfTab("lines");
    case "side":
    case "halfplane":
      return itemsOfTab("halfplanes");
    case "dense":
      return itemsOfTab("dense");
    case "coplanar":
      return itemsOfTab("coplanar");
    case "corner":
      return itemsOfTab("adjacency");
    case "group":
      return itemsOfTab("groups");
    case "facet":
    case "surface":
      return itemsOfTab("facets");
    case "rejectedFacet":
      return numbered(verification?.rejected.length, (index) => ({ kind: "rejectedFacet", index }));
    case "footprint":
      return numbered(verification?.register?.footprints.length, (index) => ({ kind: "footprint", index }));
    case "refinement":
      return itemsOfTab("refinement");
    case "relation":
      return numbered(refinement?.buildings[picked.building]?.relations.length, (index) => ({
        ...picked,
        index,
      }));
    case "region":
      return regionsOf(picked.view);
    case "pair":
      return itemsOfTab("rectangles");
    case "cluster":
      return numbered(clusters?.[picked.plane]?.refused.length, (index) => ({ ...picked, index }));
    case "view":
      return itemsOfTab("images");
  }
}

/** Where the selected thing stands among its neighbours; -1 where it does not. */
export function placeAmong(items: readonly Selection[], picked: Selection | null): number {
  const wanted = picked === null ? null : formatSelection(picked);
  return wanted === null ? -1 : items.findIndex((one) => formatSelection(one) === wanted);
}

function itemsOfTab(name: Tab): readonly Selection[] {
  const { lines, coplanar, adjacency, dense, grouping, facets, refinement, rectangles } = results.value;
  const view = Math.max(0, shownView.value);
  switch (name) {
    case "images":
      return numbered(scene.value?.views.length, (index) => ({ kind: "view", index }));
    case "segments":
    case "matches":
    case "directions":
      return segmentsOf(view);
    case "regions":
      return regionsOf(view);
    case "lines":
    case "clusters":
      return numbered((lines?.length ?? 0) / LINE_STRIDE, (index) => ({ kind: "line", index }));
    case "halfplanes":
      return sides();
    case "dense":
      return numbered(dense?.planes.length, (index) => ({ kind: "dense", index }));
    case "coplanar":
      return numbered(coplanar?.sets.length, (index) => ({ kind: "coplanar", index }));
    case "adjacency":
      return numbered(adjacency?.trace.corners.length, (index) => ({ kind: "corner", index }));
    case "groups":
      return numbered(grouping?.groups.length, (index) => ({ kind: "group", index }));
    case "refinement":
      return numbered(refinement?.buildings.length, (index) => ({ kind: "refinement", index }));
    case "rectangles":
      return numbered(rectangles?.pairs.length, (index) => ({ kind: "pair", index }));
    case "facets":
    case "model":
      return numbered(facets?.length, (index) => ({ kind: "facet", index }));
  }
}

/** Every side of every line: its half-plane where it has one. */
function sides(): readonly Selection[] {
  const { halfPlanes } = results.value;
  const own = new Map(halfPlanes?.map(({ line, side }, index) => [`${line} ${side}`, index]));
  return results.value.sides.map(({ line, side }) => {
    const index = own.get(`${line} ${side}`);
    return index === undefined ? { kind: "side", line, side } : { kind: "halfplane", index };
  });
}

function segmentsOf(view: number): readonly Selection[] {
  return numbered((results.value.segments[view]?.length ?? 0) / SEGMENT_STRIDE, (index) => ({
    kind: "segment",
    view,
    index,
  }));
}

function regionsOf(view: number): readonly Selection[] {
  return numbered(results.value.regions[view]?.regions.length, (index) => ({ kind: "region", view, index }));
}

function numbered(count: number | undefined, item: (index: number) => Selection): readonly Selection[] {
  return Array.from({ length: count ?? 0 }, (_, index) => item(index));
}

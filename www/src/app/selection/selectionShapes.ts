/** What a selection is in space: polylines in the local frame, which light up in every image and in the 3D view. */

import { LINE_STRIDE } from "../../shared/flatArrays";
import { densePlanesOf, type HalfPlane, type Segment3, type Vec3 } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { edgesOf, isVerified } from "../../viewer/layers/adjacency";
import { fanCorners } from "../../viewer/layers/fans";
import { outlinesOf } from "../../viewer/layers/refinement";
import { results } from "../state/results";
import { refinedFacets } from "./refinedBuildings";

/** A line, a closed outline with what is inside it, or the outline of what was there before. */
export interface Shape {
  points: readonly Vec3[];
  role: "line" | "area" | "before";
}

export function shapesOf(picked: Selection | null): Shape[] {
  switch (picked?.kind) {
    case "line":
      return linesShape([picked.index]);
    case "side":
      return linesShape([picked.line]);
    case "halfplane": {
      const halfPlane = results.value.halfPlanes?.[picked.index];
      return halfPlane === undefined ? [] : areas([fanOf(halfPlane)]);
    }
    case "dense":
      return areas([densePlaneRing(picked.index)]);
    case "coplanar":
      return coplanarShape(picked.index);
    case "corner":
      return cornerShape(picked.index);
    case "group":
      return groupShape(picked.index);
    case "facet":
      return areas(facetRings(picked.index));
    case "surface":
      return picked.facet === null ? [] : areas(facetRings(picked.facet));
    case "rejectedFacet":
      return areas([results.value.grouping?.rejected[picked.index]?.outline ?? []]);
    case "cluster":
      return openLine(clusterEnds(picked.plane, picked.index));
    case "refinement":
      return [
        ...ringsBefore(picked.index).map((points): Shape => ({ points, role: "before" })),
        ...areas(refinedFacets(picked.index).flatMap(facetRings)),
      ];
    case "relation":
      return relationOf(picked.building, picked.index).flatMap(({ p0, p1 }) => openLine([p0, p1]));
    case "pair":
      return linesShape(results.value.rectangles?.pairs[picked.index]?.lines ?? []);
    default:
      return [];
  }
}

/** The end points of a 3D line; none where there is no such line. */
export function lineEnds(index: number): Vec3[] {
  const lines = results.value.lines;
  const at = index * LINE_STRIDE;
  if (lines === null || at + LINE_STRIDE > lines.length) {
    return [];
  }
  const n = [...lines.subarray(at, at + LINE_STRIDE)] as [number, number, number, number, number, number];
  return [
    [n[0], n[1], n[2]],
    [n[3], n[4], n[5]],
  ];
}

/** The 3D lines that belong to a selection. */
export function linesOfSelection(picked: Selection | null): readonly number[] {
  const { halfPlanes, coplanar, facets, rectangles, matching } = results.peek();
  switch (picked?.kind) {
    case "line":
      return [picked.index];
    case "side":
      return [picked.line];
    case "halfplane":
      return [halfPlanes?.[picked.index]?.line ?? -1].filter((line) => line >= 0);
    case "coplanar":
      return coplanar?.sets[picked.index]?.lines ?? [];
    case "group":
      return groupLines(picked.index);
    case "facet":
      return facets?.[picked.index]?.lines ?? [];
    case "surface":
      return picked.facet === null ? [] : (facets?.[picked.facet]?.lines ?? []);
    case "pair":
      return rectangles?.pairs[picked.index]?.lines ?? [];
    case "segment":
      return matching === null ? [] : lineOfSegment(picked.view, picked.index);
    default:
      return [];
  }
}

/** The 3D line that a segment supports, if any. */
export function lineOfSegment(view: number, segment: number): number[] {
  const line = results
    .peek()
    .records.findIndex(({ supports }) =>
      supports.some((support) => support.view === view && support.segments.includes(segment)),
    );
  return line < 0 ? [] : [line];
}

/** The 3D lines of a plane group, each once. */
function groupLines(index: number): number[] {
  const members = results.value.grouping?.groups[index]?.members ?? [];
  return [...new Set(members.map(({ line }) => line))];
}

/** The lines of a group, or, where it has none, the dense planes that proposed its plane. */
function groupShape(index: number): Shape[] {
  const lines = linesShape(groupLines(index));
  const group = results.value.grouping?.groups[index];
  return lines.length > 0 || group === undefined ? lines : areas(densePlanesOf(group).map(densePlaneRing));
}

/** A set's polygon, over the hull that it was made from. */
function coplanarShape(index: number): Shape[] {
  const set = results.value.coplanar?.sets[index];
  return set === undefined ? [] : [{ points: set.hull, role: "before" }, ...areas([set.polygon])];
}

/** The edges of a corner, and the planes of the regions between them that the photographs verify. */
function cornerShape(index: number): Shape[] {
  const { planes, trace } = results.value.adjacency ?? { planes: [], trace: null };
  const corner = trace?.corners[index];
  if (trace === null || corner === undefined) {
    return [];
  }
  const own = planes.filter(
    (plane) => isVerified(plane) && plane.regions.some(([proposer]) => proposer === index),
  );
  return [
    ...areas(own.map(({ polygon }) => polygon)),
    ...edgesOf(corner, trace.corners).flatMap(([from, to]) => openLine([from, to])),
  ];
}

function densePlaneRing(index: number): readonly Vec3[] {
  return results.value.dense?.planes[index]?.ring ?? [];
}

/** A cluster has no ends (W96 3.5): it is drawn as far as any line of its direction reaches. */
function clusterEnds(plane: number, index: number): Vec3[] {
  const trace = results.value.clusters?.[plane];
  const [place] = trace?.refused[index] ?? [];
  const { lines } = results.value;
  if (trace === undefined || place === undefined || lines === null) {
    return [];
  }
  const [c, s] = [Math.cos(trace.azimuth), Math.sin(trace.azimuth)];
  const along = Array.from({ length: lines.length / 3 }, (_, i) => i * 3).map(
    (at) => c * (lines[at] as number) + s * (lines[at + 1] as number),
  );
  const [across, height] = place;
  const at = (t: number): Vec3 => [c * t - s * across, s * t + c * across, height];
  return along.length === 0 ? [] : [at(Math.min(...along)), at(Math.max(...along))];
}

function linesShape(indices: readonly number[]): Shape[] {
  return indices.flatMap((line) => openLine(lineEnds(line)));
}

function openLine(points: readonly Vec3[]): Shape[] {
  return points.length < 2 ? [] : [{ points, role: "line" }];
}

function areas(rings: readonly (readonly Vec3[])[]): Shape[] {
  return rings.filter((ring) => ring.length > 0).map((points) => ({ points, role: "area" }));
}

function ringsBefore(building: number): readonly (readonly Vec3[])[] {
  const { refinement } = results.value;
  return refinement === null ? [] : outlinesOf(refinement, building);
}

function relationOf(building: number, index: number): readonly Segment3[] {
  return results.value.refinement?.trace.buildings[building]?.relations[index]?.sides ?? [];
}

function facetRings(index: number): readonly (readonly Vec3[])[] {
  const facet = results.value.facets?.[index];
  return facet === undefined ? [] : [facet.outer, ...facet.holes];
}

function fanOf(halfPlane: HalfPlane): Vec3[] {
  const { lines } = results.value;
  return lines === null ? [] : fanCorners(halfPlane, lines).map(({ x, y, z }) => [x, y, z]);
}

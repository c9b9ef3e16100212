/** What a selection is in space: polylines in the local frame, which light up in every image and in the 3D view. */

import { LINE_STRIDE } from "../../shared/flatArrays";
import { edgesOfCorner, isVerifiedPlane, outlinesBefore } from "../../shared/proposed";
import { densePlanesOf, type Segment3, type Vec3 } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import type { Results } from "../../stages/list";
import { fanRing } from "../../viewer/scene/fanRing";
import { refinedFacets } from "./refinedBuildings";

/** A line, a closed outline with what is inside it, or the outline of what was there before. */
export interface Shape {
  points: readonly Vec3[];
  role: "line" | "area" | "before";
}

export function shapesOf(picked: Selection | null, results: Results): Shape[] {
  switch (picked?.kind) {
    case "line":
      return linesShape([picked.index], results);
    case "side":
      return linesShape([picked.line], results);
    case "halfplane": {
      const halfPlane = results.halfPlanes?.[picked.index];
      return halfPlane === undefined || results.lines === null
        ? []
        : areas([fanRing(halfPlane, results.lines)]);
    }
    case "dense":
      return areas([densePlaneRing(picked.index, results)]);
    case "coplanar":
      return coplanarShape(picked.index, results);
    case "corner":
      return cornerShape(picked.index, results);
    case "group":
      return groupShape(picked.index, results);
    case "facet":
      return areas(facetRings(picked.index, results));
    case "surface":
      return picked.facet === null ? [] : areas(facetRings(picked.facet, results));
    case "rejectedFacet":
      return areas([results.verification?.rejected[picked.index]?.outline ?? []]);
    case "cluster":
      return openLine(clusterEnds(picked.plane, picked.index, results));
    case "refinement":
      return [
        ...ringsBefore(picked.index, results).map((points): Shape => ({ points, role: "before" })),
        ...areas(refinedFacets(picked.index, results).flatMap((facet) => facetRings(facet, results))),
      ];
    case "relation":
      return relationOf(picked.building, picked.index, results).flatMap(({ p0, p1 }) => openLine([p0, p1]));
    case "pair":
      return linesShape(results.rectangles?.pairs[picked.index]?.lines ?? [], results);
    default:
      return [];
  }
}

/** The end points of a 3D line; none where there is no such line. */
export function lineEnds(index: number, { lines }: Pick<Results, "lines">): Vec3[] {
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
export function linesOfSelection(picked: Selection | null, results: Results): readonly number[] {
  const { halfPlanes, coplanar, facets, rectangles, matching } = results;
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
      return groupLines(picked.index, results);
    case "facet":
      return facets?.[picked.index]?.lines ?? [];
    case "surface":
      return picked.facet === null ? [] : (facets?.[picked.facet]?.lines ?? []);
    case "pair":
      return rectangles?.pairs[picked.index]?.lines ?? [];
    case "segment":
      return matching === null ? [] : lineOfSegment(picked.view, picked.index, results);
    default:
      return [];
  }
}

/** The 3D line that a segment supports, if any. */
export function lineOfSegment(
  view: number,
  segment: number,
  { records }: Pick<Results, "records">,
): number[] {
  const line = records.findIndex(({ supports }) =>
    supports.some((support) => support.view === view && support.segments.includes(segment)),
  );
  return line < 0 ? [] : [line];
}

/** The 3D lines of a plane group, each once. */
function groupLines(index: number, results: Results): number[] {
  const members = results.grouping?.groups[index]?.members ?? [];
  return [...new Set(members.map(({ line }) => line))];
}

/** The lines of a group, or, where it has none, the dense planes that proposed its plane. */
function groupShape(index: number, results: Results): Shape[] {
  const lines = linesShape(groupLines(index, results), results);
  const group = results.grouping?.groups[index];
  return lines.length > 0 || group === undefined
    ? lines
    : areas(densePlanesOf(group).map((plane) => densePlaneRing(plane, results)));
}

/** A set's polygon, over the hull that it was made from. */
function coplanarShape(index: number, results: Results): Shape[] {
  const set = results.coplanar?.sets[index];
  return set === undefined ? [] : [{ points: set.hull, role: "before" }, ...areas([set.polygon])];
}

/** The edges of a corner, and the planes of the regions between them that the photographs verify. */
function cornerShape(index: number, results: Results): Shape[] {
  const { planes, trace } = results.adjacency ?? { planes: [], trace: null };
  const corner = trace?.corners[index];
  if (trace === null || corner === undefined) {
    return [];
  }
  const own = planes.filter(
    (plane) => isVerifiedPlane(plane) && plane.regions.some(([proposer]) => proposer === index),
  );
  return [
    ...areas(own.map(({ polygon }) => polygon)),
    ...edgesOfCorner(corner, trace.corners).flatMap(([from, to]) => openLine([from, to])),
  ];
}

function densePlaneRing(index: number, results: Results): readonly Vec3[] {
  return results.dense?.planes[index]?.ring ?? [];
}

/** A cluster has no ends (W96 3.5): it is drawn as far as any line of its direction reaches. */
function clusterEnds(plane: number, index: number, results: Results): Vec3[] {
  const trace = results.clusters?.[plane];
  const [place] = trace?.refused[index] ?? [];
  const { lines } = results;
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

function linesShape(indices: readonly number[], results: Results): Shape[] {
  return indices.flatMap((line) => openLine(lineEnds(line, results)));
}

function openLine(points: readonly Vec3[]): Shape[] {
  return points.length < 2 ? [] : [{ points, role: "line" }];
}

function areas(rings: readonly (readonly Vec3[])[]): Shape[] {
  return rings.filter((ring) => ring.length > 0).map((points) => ({ points, role: "area" }));
}

function ringsBefore(building: number, results: Results): readonly (readonly Vec3[])[] {
  const { refinement } = results;
  return refinement === null ? [] : outlinesBefore(refinement, building);
}

function relationOf(building: number, index: number, results: Results): readonly Segment3[] {
  return results.refinement?.buildings[building]?.relations[index]?.sides ?? [];
}

function facetRings(index: number, results: Results): readonly (readonly Vec3[])[] {
  const facet = results.facets?.[index];
  return facet === undefined ? [] : [facet.outer, ...facet.holes];
}

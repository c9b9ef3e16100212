/** A group of coplanar lines, half-planes and other proposals (B99 4.2). */
import {
  coplanarSetsOf,
  cornerPlanesOf,
  densePlanesOf,
  isMadeFrom,
  type PlaneGroup,
  rectanglesOf,
} from "../../shared/records";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { indicesOf, links, numbered, type Rows, slopeText } from "../parts/rows";
import { linesShape } from "../parts/shapes";
import dense from "./dense";

export default {
  title: "Group",
  rows({ index }, { results }) {
    const group = results.grouping?.groups[index];
    if (group === undefined) {
      return [];
    }
    const halfPlanes = group.members.flatMap(({ half_plane }) => (half_plane === null ? [] : [half_plane]));
    const facets = indicesOf(results.facets, (facet) => isMadeFrom(facet, group));
    return [
      ["Slope of the plane", slopeText(group.plane.normal)],
      links("3D lines", "line", linesOfGroup(index, results)),
      links("Half-planes", "halfplane", halfPlanes),
      ...proposalRows(group, results),
      links("Facets", "facet", facets),
    ];
  },
  siblings: (_, { results: { grouping } }) => numbered("group", grouping?.groups.length),
  /** Its lines, or, where it has none, the dense planes that proposed its plane. */
  shapes({ index }, results) {
    const lines = linesShape(linesOfGroup(index, results), results);
    const group = results.grouping?.groups[index];
    return lines.length > 0 || group === undefined
      ? lines
      : densePlanesOf(group).flatMap((plane) => dense.shapes({ kind: "dense", index: plane }, results));
  },
  lines: ({ index }, results) => linesOfGroup(index, results),
} satisfies Kind<"group">;

/** Each once. */
function linesOfGroup(index: number, { grouping }: Results): number[] {
  return [...new Set(grouping?.groups[index]?.members.map(({ line }) => line))];
}

/** The planes of dense matching, the coplanar sets and the corners that proposed a plane, and how many candidates of the other method. */
export function proposalRows(proposed: Pick<PlaneGroup, "proposals">, { adjacency }: Results): Rows {
  const [planes, sets] = [densePlanesOf(proposed), coplanarSetsOf(proposed)];
  const rectangles = rectanglesOf(proposed).length;
  const regions = cornerPlanesOf(proposed).flatMap((plane) => adjacency?.planes[plane]?.regions ?? []);
  const corners = [...new Set(regions.map(([corner]) => corner))];
  return [
    planes.length > 0 && links("Dense planes", "dense", planes),
    sets.length > 0 && links("Coplanar sets", "coplanar", sets),
    corners.length > 0 && links("Proposed by corners", "corner", corners),
    rectangles > 0 && ["Rectangles", `${rectangles} in its plane`],
  ];
}

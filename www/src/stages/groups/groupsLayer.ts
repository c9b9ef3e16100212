/**
 * Groups of coplanar half-planes in colours of their own (B99 figures 17 to 20): the lines, the facets that they became, and
 * names on these. Lines of groups without a facet, most of them on the ground, are thin and dim.
 */

import { Color } from "three";
import { category, PALETTE } from "../../shared/palette";
import { type Facet, type GroupingTrace, isMadeFrom, type Segment3 } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import { facetMesh, triangulate } from "../../viewer/layers/facets";
import { isOfRoof, middleOf } from "../../viewer/scene/facetPlan";
import type { Layer } from "../../viewer/scene/layer";
import { nameLabels } from "../../viewer/scene/nameLabels";
import { partsLayer } from "../../viewer/scene/partsLayer";
import { endsOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = { roof: 3, other: 1.25, found: 1.75, selected: 5 };
/** Alone, and while something is selected. */
const OPACITY = { roof: [1, 0.3], other: [0.35, 0.105], found: [0.8, 0.24], area: [0.45, 0.135] } as const;

/**
 * @param lines p0 and p1 of each 3D line, local frame, metres
 * @param facets what the groups became
 */
export function buildGroups(
  grouping: GroupingTrace,
  lines: Float64Array,
  facets: readonly Facet[] = [],
): Layer {
  const became = facets.map((facet) => groupOf(facet, grouping));
  const owner = owners(grouping, new Set(became));
  const isRoof = ([, group]: readonly [number, number]) => facets.length === 0 || became.includes(group);
  const roof = [...owner].filter(isRoof);
  const other = [...owner].filter((one) => !isRoof(one));
  const drawn = (members: readonly (readonly [number, number])[], look: "roof" | "other") => {
    const ends = members.flatMap(([line]) => endsOf(lines, line));
    const things = members.map(([, group]) => group);
    return {
      drawn: strokes(ends, things.map(category), WIDTH_PX[look]),
      opacity: OPACITY[look],
      things,
    };
  };
  const outlines = facets.map(({ outer }) => outer);
  const found = grouping.plane_lines.filter(
    ({ segment }) => facets.length === 0 || isOver(segment, outlines),
  );
  const areas = facetMesh(
    facets.map(triangulate),
    became.map((group) => new Color(group < 0 ? PALETTE.unmatched : category(group))),
  );
  const foundEnds = found.flatMap(({ segment }) => [...segment.p0, ...segment.p1]);
  const groupOfTriangle = facets.flatMap((facet, i) =>
    new Array<number>(triangulate(facet).length / 9).fill(became[i] as number),
  );
  return partsLayer({
    kind: "group",
    parts: [
      drawn(roof, "roof"),
      drawn(other, "other"),
      { drawn: strokes(foundEnds, PALETTE.border, WIDTH_PX.found), opacity: OPACITY.found },
      { drawn: areas, opacity: OPACITY.area, things: groupOfTriangle },
    ],
    beside: [nameLabels(namesOf(facets, became))],
    chosen: (index) => {
      const own = [...new Set(grouping.groups[index]?.members.map(({ line }) => line))];
      const positions = own.flatMap((line) => endsOf(lines, line));
      return own.length === 0 ? null : strokes(positions, PALETTE.selected, WIDTH_PX.selected);
    },
  });
}

/** The group that each line is drawn for: of several, one that became a facet, and of these the largest. */
function owners(grouping: GroupingTrace, became: ReadonlySet<number>): Map<number, number> {
  const order = grouping.groups
    .map((group, index) => ({ group, index }))
    .sort(
      (a, b) =>
        Number(became.has(b.index)) - Number(became.has(a.index)) ||
        b.group.members.length - a.group.members.length,
    );
  const owner = new Map<number, number>();
  for (const { group, index } of order) {
    for (const { line } of group.members) {
      if (!owner.has(line)) {
        owner.set(line, index);
      }
    }
  }
  return owner;
}

/** The group that a facet was made from; -1 where none says so. */
function groupOf(facet: Facet, { groups }: GroupingTrace): number {
  return groups.findIndex((group) => isMadeFrom(facet, group));
}

/** Each group's number on its largest facet. */
function namesOf(facets: readonly Facet[], became: readonly number[]) {
  const size = ({ outer }: Facet) =>
    Math.max(...outer.map(([x, y]) => Math.hypot(x - (outer[0]?.[0] ?? 0), y - (outer[0]?.[1] ?? 0))));
  const largest = new Map<number, Facet>();
  facets.forEach((facet, i) => {
    const group = became[i] as number;
    const last = largest.get(group);
    if (group >= 0 && (last === undefined || size(facet) > size(last))) {
      largest.set(group, facet);
    }
  });
  return [...largest].map(([group, { outer }]) => ({ text: String(numberOf(group)), at: middleOf(outer) }));
}

/** Whether a line lies over a facet and not below the roof. */
function isOver({ p0, p1 }: Segment3, outlines: readonly Facet["outer"][]): boolean {
  const height = (p0[2] + p1[2]) / 2;
  const near = outlines.filter((ring) => ring.some(([, , z]) => z <= height + BELOW_M));
  return isOfRoof({ a: [p0[0], p0[1]], b: [p1[0], p1[1]] }, near);
}

/** A line so far below the lowest corner of a facet is not of it. */
const BELOW_M = 0.5;

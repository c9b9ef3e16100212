/** What the tour's steps are about, chosen by the results: a step's claim holds for what it shows. */
import { LINE_STRIDE, STRETCH_STRIDE } from "../../shared/flatArrays";
import { isVerifiedPlane } from "../../shared/proposed";
import { coplanarSetsOf, densePlanesOf, isMadeFrom, type Side, type SideTrace } from "../../shared/records";
import { type ClassName, likeliestClass } from "../../shared/surfaceClass";
import type { Results } from "../state/results";

const DEGREE = Math.PI / 180;

/** So far from its peak a curve is asked how deep it falls: near enough to be the same peak's flank, far enough to be seen. */
const AWAY = { least: 25 * DEGREE, most: 45 * DEGREE };
/** Flatter half-planes are found without turning. */
const LEAST_SLOPE = 15 * DEGREE;

/** Reasons that say: the views agree at no angle. */
const NO_AGREEMENT: ReadonlySet<string> = new Set(["low_peak", "no_valid_view"]);

export interface SideOfLine {
  line: number;
  side: Side;
}

/** Length of a segment in its photograph, pixels. */
export function segmentLength({ segments }: Pick<Results, "segments">, view: number, index: number): number {
  const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = segments[view]?.subarray(4 * index, 4 * index + 4) ?? [];
  return Math.hypot(x1 - x0, y1 - y0);
}

/** The facet that a segment shows a side of; null where there is none. */
export function facetOfSegment(
  { records, facets }: Pick<Results, "records" | "facets">,
  view: number,
  segment: number,
): number | null {
  const line = records.findIndex(({ supports }) =>
    supports.some((one) => one.view === view && one.segments.includes(segment)),
  );
  const facet = facets?.findIndex(({ lines }) => lines?.includes(line)) ?? -1;
  return line < 0 || facet < 0 ? null : facet;
}

/** The segments of a view that show a side of a facet, the longest first. */
export function roofSegments(all: Pick<Results, "segments" | "records" | "facets">, view: number): number[] {
  const roof = roofLines(all);
  return all.records
    .flatMap(({ supports }, line) => (roof.has(line) ? supports : []))
    .flatMap((support) => (support.view === view ? support.segments : []))
    .sort((a, b) => segmentLength(all, view, b) - segmentLength(all, view, a));
}

/** Longest stretch of a 3D line that segments showed before growing, and its length now, metres. */
export function growthOf(
  { lines, stretches }: Pick<Results, "lines" | "stretches">,
  line: number,
): { before: number; after: number } {
  const own = stretches ?? new Float64Array();
  let before = 0;
  for (let at = 0; at < own.length; at += STRETCH_STRIDE) {
    if (own[at] === line) {
      before = Math.max(before, lengthAt(own, at + 1));
    }
  }
  return { before, after: lines === null ? 0 : lengthAt(lines, line * LINE_STRIDE) };
}

/** Half-planes of facets that are steep enough for the angle to matter. */
export function slopedHalfPlanes(all: Pick<Results, "halfPlanes" | "facets">): SideOfLine[] {
  const used = new Set(all.facets?.flatMap(({ half_planes }) => half_planes ?? []));
  return (all.halfPlanes ?? []).filter(({ theta }, i) => used.has(i) && Math.abs(theta) > LEAST_SLOPE);
}

/** How much Sim falls from the peak at `theta` (radians), and at which angle. */
export function fallOf(
  { curve: { thetas, similarity } }: SideTrace,
  theta: number,
): { at: number; by: number } {
  const away = thetas.map((one, i) => ({ at: one, sim: similarity[i] ?? 0 }));
  const near = away.reduce((a, b) => (Math.abs(b.at - theta) < Math.abs(a.at - theta) ? b : a), {
    at: Number.POSITIVE_INFINITY,
    sim: 0,
  });
  const lowest = away
    .filter(({ at }) => Math.abs(at - theta) >= AWAY.least && Math.abs(at - theta) <= AWAY.most)
    .reduce((a, b) => (b.sim < a.sim ? b : a), { at: theta, sim: Number.POSITIVE_INFINITY });
  return { at: lowest.at, by: Math.max(0, near.sim - lowest.sim) };
}

/** Lines along which a roof ends: a facet's half-plane on one side, and on the other no agreement at any angle. */
export function roofEnds(all: Pick<Results, "halfPlanes" | "facets" | "sides">): SideOfLine[] {
  const roof = roofLines(all);
  const accepted = new Set(all.halfPlanes?.map(({ line }) => line));
  return all.sides.filter(
    ({ line, rejection }) => accepted.has(line) && roof.has(line) && rejection === "low_peak",
  );
}

/** Whether the views agree on a side at no angle, and that is why it was rejected. */
export function agreesNowhere({ rejection }: Pick<SideTrace, "rejection">): boolean {
  return rejection !== null && NO_AGREEMENT.has(rejection);
}

/** The highest Sim of a curve. */
export function highestSim({ curve }: SideTrace): number {
  return Math.max(0, ...curve.similarity);
}

/** The lines of a group, and the facets that it became. */
export function groupParts(
  { grouping, facets }: Pick<Results, "grouping" | "facets">,
  group: number,
): { lines: number; facets: number[] } {
  const found = grouping?.groups[group];
  return found === undefined
    ? { lines: 0, facets: [] }
    : {
        lines: new Set(found.members.map(({ line }) => line)).size,
        facets: (facets ?? []).flatMap((facet, i) => (isMadeFrom(facet, found) ? [i] : [])),
      };
}

export interface CoplanarSetParts {
  lines: number;
  /** Sides without a line that were made square or mirrored. */
  moved: number;
  /** The facets that it proposed. */
  facets: number[];
}

/** What a set of coplanar lines is; null where there is none. */
export function coplanarSetParts(
  { coplanar, facets }: Pick<Results, "coplanar" | "facets">,
  index: number,
): CoplanarSetParts | null {
  const [set, trace] = [coplanar?.sets[index], coplanar?.trace.sets[index]];
  if (set === undefined || trace === undefined) {
    return null;
  }
  return {
    lines: set.lines.length,
    moved: trace.closing.length,
    facets: (facets ?? []).flatMap((facet, i) => (coplanarSetsOf(facet).includes(index) ? [i] : [])),
  };
}

export interface CornerParts {
  views: number;
  edges: number;
  /** Planes of its regions that the photographs verify. */
  planes: number;
}

/** What a corner in space is; null where there is none. */
export function cornerParts({ adjacency }: Pick<Results, "adjacency">, index: number): CornerParts | null {
  const corner = adjacency?.trace.corners[index];
  const own = adjacency?.planes.filter(
    (plane) => isVerifiedPlane(plane) && plane.regions.some(([proposer]) => proposer === index),
  );
  return corner === undefined
    ? null
    : { views: corner.images.length, edges: corner.edges.length, planes: own?.length ?? 0 };
}

export interface DensePlaneParts {
  name: ClassName;
  probability: number;
  patches: number;
  rmsM: number;
  /** The facets that it proposed, and how many half-planes these were made from. */
  facets: number[];
  halfPlanes: number;
}

/** What a plane of dense matching is, and what became of it; null where there is none. */
export function densePlaneParts(
  { dense, facets }: Pick<Results, "dense" | "facets">,
  index: number,
): DensePlaneParts | null {
  const plane = dense?.planes[index];
  const proposed = (facets ?? []).flatMap((facet, i) => (densePlanesOf(facet).includes(index) ? [i] : []));
  return plane === undefined
    ? null
    : {
        ...likeliestClass(plane.class),
        patches: plane.patches.length,
        rmsM: plane.rms_m,
        facets: proposed,
        halfPlanes: new Set(proposed.flatMap((i) => facets?.[i]?.half_planes ?? [])).size,
      };
}

/** The 3D lines at the sides of facets. */
function roofLines({ facets }: Pick<Results, "facets">): ReadonlySet<number> {
  return new Set(facets?.flatMap(({ lines }) => lines ?? []));
}

function lengthAt(numbers: Float64Array, at: number): number {
  const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0] = numbers.subarray(at, at + LINE_STRIDE);
  return Math.hypot(d - a, e - b, f - c);
}

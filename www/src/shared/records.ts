/**
 * The records that cross the worker boundary. Rust declares them where they are made, and the build writes their
 * types into the package: lengths in metres (local frame: the input's map frame minus `SceneInfo.origin`, Z up), angles
 * in radians, indices into views, segments of their view, 3D lines, half-planes, facets.
 */
import type { Facet, PlaneGroup, SideRecord } from "../pkg/ridgeline.js";

export type * from "../pkg/ridgeline.js";

/** Was the side swept, and given up? Lines on the ground are not swept, nor what coplanar lines explain. */
export function isRejected({ rejection }: SideRecord): boolean {
  return rejection !== null && rejection !== "on_ground";
}

type Proposed = Pick<Facet | PlaneGroup, "proposals">;

type KeyOf<Union> = Union extends unknown ? keyof Union : never;

/** What of one source proposed a plane. */
const proposers =
  (source: KeyOf<Proposed["proposals"][number]>) =>
  ({ proposals }: Proposed): number[] =>
    proposals.flatMap((one: Readonly<Record<string, number>>) => one[source] ?? []);

/** Candidates of W96 that proposed a plane. */
export const rectanglesOf = proposers("rectangle");
/** Planes of dense matching that did. */
export const densePlanesOf = proposers("dense_plane");
/** Sets of coplanar lines that did. */
export const coplanarSetsOf = proposers("coplanar_set");
/** Planes of corners that did. */
export const cornerPlanesOf = proposers("corner_plane");

/** Whether a facet was made from a group: they share a half-plane or a proposal. */
export function isMadeFrom(
  { half_planes, ...facet }: Pick<Facet, "half_planes" | "proposals">,
  { members, ...group }: Pick<PlaneGroup, "members" | "proposals">,
): boolean {
  const sources = [rectanglesOf, densePlanesOf, coplanarSetsOf, cornerPlanesOf];
  return (
    members.some(({ half_plane }) => half_plane !== null && half_planes.includes(half_plane)) ||
    sources.some((of) => of(group).some((one) => of(facet).includes(one)))
  );
}

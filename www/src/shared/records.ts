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

/** Candidates of W96 that proposed a plane. */
export function rectanglesOf({ proposals }: Proposed): number[] {
  return proposals.flatMap((one) => ("rectangle" in one ? [one.rectangle] : []));
}

/** Planes of dense matching that proposed a plane. */
export function densePlanesOf({ proposals }: Proposed): number[] {
  return proposals.flatMap((one) => ("dense_plane" in one ? [one.dense_plane] : []));
}

/** Sets of coplanar lines that proposed a plane. */
export function coplanarSetsOf({ proposals }: Proposed): number[] {
  return proposals.flatMap((one) => ("coplanar_set" in one ? [one.coplanar_set] : []));
}

/** Planes of corners that proposed a plane. */
export function cornerPlanesOf({ proposals }: Proposed): number[] {
  return proposals.flatMap((one) => ("corner_plane" in one ? [one.corner_plane] : []));
}

/** Whether a facet was made from a group: they share a half-plane or a proposal. */
export function isMadeFrom(
  { half_planes, ...facet }: Pick<Facet, "half_planes" | "proposals">,
  { members, ...group }: Pick<PlaneGroup, "members" | "proposals">,
): boolean {
  const shares = (of: (from: Proposed) => number[]) => of(group).some((one) => of(facet).includes(one));
  return (
    members.some(({ half_plane }) => half_plane !== null && half_planes.includes(half_plane)) ||
    shares(rectanglesOf) ||
    shares(densePlanesOf) ||
    shares(coplanarSetsOf) ||
    shares(cornerPlanesOf)
  );
}

/** What coplanar sets, corners and refinement hold in space, and whether the photographs verify it (B99 2). */
import type { CoplanarSet, CornerPlane, Refinement, SpaceCorner, Vec3 } from "./records";

/** Do the photographs speak for the polygon of a coplanar set? */
export function isVerifiedSet({ inside_nats, outline_nats }: CoplanarSet): boolean {
  return inside_nats + outline_nats > 0;
}

/** Do the photographs speak for the plane of a region? */
export function isVerifiedPlane(plane: CornerPlane | undefined): boolean {
  return plane !== undefined && plane.prior_nats + plane.inside_nats > 0;
}

/** The edges of a corner: from it to where they end, or to the corners that they lead to. */
export function edgesOfCorner(
  corner: SpaceCorner,
  corners: readonly SpaceCorner[],
): (readonly [Vec3, Vec3])[] {
  const [x, y, z] = corner.at;
  return corner.edges.map(({ direction: [dx, dy, dz], length_m: t, neighbour }) => [
    corner.at,
    corners[neighbour ?? -1]?.at ?? [x + t * dx, y + t * dy, z + t * dz],
  ]);
}

/** The rings of a building's facets before refinement. */
export function outlinesBefore(refinement: Refinement, building: number): (readonly Vec3[])[] {
  const own = refinement.before.facets.filter((facet) => facet.building === building);
  return own.flatMap(({ outer, holes }) => [outer, ...holes]);
}

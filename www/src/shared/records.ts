/**
 * The records that cross the worker boundary. Rust declares them where they are made, and the build writes their
 * types into the package: lengths in metres (local frame: the input's map frame minus `SceneInfo.origin`, Z up), angles
 * in radians, indices into views, segments of their view, 3D lines, half-planes, facets.
 */
import type { SideRecord } from "../pkg/ridgeline.js";

export type * from "../pkg/ridgeline.js";

/** Was the side swept, and given up? Lines on the ground are not swept. */
export function isRejected({ rejection }: SideRecord): boolean {
  return rejection !== null && rejection !== "on_ground";
}

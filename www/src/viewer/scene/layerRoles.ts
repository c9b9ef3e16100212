/** What the layers of the viewer are there for, by their names. */

/** Layers in the order in which a click tries them. */
export const PICK_ORDER = [
  "groups",
  "stretches",
  "lines",
  "uncertainty",
  "fans",
  "coplanar",
  "adjacency",
  "dense",
  "facets",
  "model",
  "cameras",
] as const;

/** Layers whose points can be measured. */
export const MEASURED = [
  "lines",
  "stretches",
  "groups",
  "coplanar",
  "adjacency",
  "dense",
  "facets",
  "model",
  "kept",
  "keptModel",
] as const;

/** Layers of the place itself, and not of one result. */
export const OF_BOTH_HALVES: ReadonlySet<string> = new Set(["grid", "measure", "handles"]);

/** Layers of faces, which a cut goes through. */
export const CUT = ["facets", "model"] as const;

/** What the layers of the viewer are there for, by their names: whoever puts them there says it. */
export interface LayerRoles {
  /** Layers in the order in which a click tries them. */
  picked: readonly string[];
  /** Layers whose points can be measured. */
  measured: readonly string[];
  /** Layers of faces, which a cut goes through. */
  cut: readonly string[];
}

/** Layers of the place itself, and not of one result. */
export const OF_BOTH_HALVES: ReadonlySet<string> = new Set(["grid", "measure", "handles"]);

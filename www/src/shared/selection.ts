/** The thing that was picked, by its index in the results; anywhere it is picked, it lights up everywhere. */
import type { Side } from "./records";

export type Selection =
  | { kind: "segment"; view: number; index: number }
  /** A line of edgels that is no segment. */
  | { kind: "rejectedSegment"; view: number; index: number }
  | { kind: "line"; index: number }
  /** A side of a 3D line, whether it has a half-plane or not. */
  | { kind: "side"; line: number; side: Side }
  | { kind: "halfplane"; index: number }
  /** A plane of dense matching. */
  | { kind: "dense"; index: number }
  /** A set of coplanar lines. */
  | { kind: "coplanar"; index: number }
  /** A corner in space with its edges and regions. */
  | { kind: "corner"; index: number }
  | { kind: "group"; index: number }
  | { kind: "facet"; index: number }
  /** A facet that was rejected. */
  | { kind: "rejectedFacet"; index: number }
  /** What refinement made of a building; one of the relations tested there. */
  | { kind: "refinement"; index: number }
  | { kind: "relation"; building: number; index: number }
  | { kind: "surface"; surface: string; building: number | null; facet: number | null; areaM2: number }
  | { kind: "view"; index: number }
  /** W96: a region of a view; a pair of parallel lines. */
  | { kind: "region"; view: number; index: number }
  | { kind: "pair"; index: number }
  /** A rejected cluster of a cluster plane; the selected ones are 3D lines. */
  | { kind: "cluster"; plane: number; index: number };

/** Where the 3D view's camera stands and what it looks at: x, y, z each, metres, local frame. */
export type Standpoint = readonly [number, number, number, number, number, number];

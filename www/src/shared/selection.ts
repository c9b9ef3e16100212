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
  /** A footprint of the register that is known beforehand. */
  | { kind: "footprint"; index: number }
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

/** "line:12", "segment:0.44" (view first), "side:12.left"; the words are a format and stay. */
export function formatSelection(picked: Selection): string | null {
  switch (picked.kind) {
    case "segment":
    case "region":
      return `${picked.kind}:${picked.view}.${picked.index}`;
    case "rejectedSegment":
      return `refused:${picked.view}.${picked.index}`;
    case "rejectedFacet":
      return `withdrawn:${picked.index}`;
    case "cluster":
      return `cluster:${picked.plane}.${picked.index}`;
    case "relation":
      return `relation:${picked.building}.${picked.index}`;
    case "side":
      return `side:${picked.line}.${picked.side}`;
    case "surface":
      return picked.facet === null ? null : `facet:${picked.facet}`;
    default:
      return `${picked.kind}:${picked.index}`;
  }
}

export function parseSelection(text: string | null): Selection | null {
  const found = /^([a-z]+):(\d{1,9})(?:\.(\d{1,9}|left|right))?$/.exec(text ?? "");
  if (found === null) {
    return null;
  }
  const [, kind, first, second] = found as unknown as [string, string, string, string | undefined];
  const index = Number(first);
  switch (kind) {
    case "segment":
    case "region":
      return /^\d+$/.test(second ?? "") ? { kind, view: index, index: Number(second) } : null;
    case "refused":
      return /^\d+$/.test(second ?? "")
        ? { kind: "rejectedSegment", view: index, index: Number(second) }
        : null;
    case "cluster":
      return /^\d+$/.test(second ?? "") ? { kind, plane: index, index: Number(second) } : null;
    case "relation":
      return /^\d+$/.test(second ?? "") ? { kind, building: index, index: Number(second) } : null;
    case "side":
      return second === "left" || second === "right" ? { kind, line: index, side: second } : null;
    case "line":
    case "halfplane":
    case "dense":
    case "coplanar":
    case "corner":
    case "group":
    case "refinement":
    case "facet":
    case "footprint":
    case "view":
    case "pair":
      return { kind, index };
    case "withdrawn":
      return { kind: "rejectedFacet", index };
    default:
      return null;
  }
}

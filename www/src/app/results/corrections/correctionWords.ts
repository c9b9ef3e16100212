/** Corrections, and why one is not applied, in words. */
import type { Correction, NotApplied } from "../../../shared/records";

const KINDS: Record<Correction["correction"], string> = {
  delete_facet: "Facet deleted",
  delete_building: "Building deleted",
  delete_obstruction: "Obstruction deleted",
  add_obstruction: "Obstruction added",
  confirm: "Facet confirmed",
  move_corner: "Corner moved",
  move_edge: "Edge moved",
  set_parallel: "Edge made parallel",
  set_level: "Facet made level",
  set_slope: "Slope set",
  set_symmetric: "Slopes made symmetric",
  set_ground: "Ground set",
  set_eave: "Eave set",
  merge: "Facets merged",
  split: "Facet divided",
  add_edge: "Edge drawn",
  add_facet: "Facet added",
  mirror: "Counterpart added",
};

/** What a correction is, with its number where it has one. */
export function correctionWords(one: Correction): string {
  const words = KINDS[one.correction];
  switch (one.correction) {
    case "set_slope":
      return `${words}: ${one.slope_deg.toFixed(1)}°`;
    case "set_ground":
    case "set_eave":
      return `${words}: ${one.height.toFixed(2)} m`;
    case "add_obstruction":
      return `${words}: ${one.height_m.toFixed(2)} m`;
    case "add_edge":
      return `${words} in ${one.photograph}`;
    case "move_corner":
      return `${words} by ${lengthText(one.from, one.to)}`;
    case "move_edge":
      return `${words} by ${lengthText(one.from[0], one.to[0])}`;
    default:
      return words;
  }
}

function lengthText(from: readonly number[], to: readonly number[]): string {
  return `${Math.hypot(...to.map((x, i) => x - (from[i] ?? 0))).toFixed(2)} m`;
}

export const NOT_APPLIED_WORDS: Record<NotApplied, string> = {
  no_facet: "no facet lies there any more",
  other_height: "the facet there has another height now",
  other_slope: "the facet there has another slope now",
  no_building: "no building stands there any more",
  no_obstruction: "nothing stands there any more",
  no_corner: "no corner lies there any more",
  no_edge: "no edge lies there any more",
  not_neighbours: "the two are no neighbours in one building",
  not_divided: "the line does not divide the facet",
  no_room: "its place is taken, or its outline encloses no roof",
  no_photograph: "no photograph has that name",
  not_in_photograph: "the two points are no edge in the photograph",
  no_line: "too few other photographs show an edge there",
  implausible: "no roof has such numbers",
  not_adjusted: "the building cannot be adjusted to it",
  would_not_close: "the building would not close",
};

/** A line of edgels that is no segment (B99 3.2). */
import { REJECTED_STRIDE } from "../../shared/flatArrays";
import type { Kind } from "../parts/kind";
import { CHOSEN, endsIn } from "../parts/marks";
import { allOf } from "../parts/rows";
import { stretchRows } from "./segment";

/** By the core's numbers for them. */
const REASONS = [
  "it is part of a curve",
  "the texture around it explains it",
  "an edge in grey values along it is a segment already",
];

export default {
  title: "Rejected line",
  rows({ view, index }, { results }) {
    const [p, q] = endsIn(results.rejected[view], index, REJECTED_STRIDE);
    const reason = results.rejected[view]?.[index * REJECTED_STRIDE + 4] ?? -1;
    return p === undefined || q === undefined
      ? []
      : [...stretchRows(p, q), ["Rejected", REASONS[reason] ?? "unknown"]];
  },
  siblings(picked, about) {
    const view = picked?.view ?? Math.max(0, about.view);
    const count = (about.results.rejected[view]?.length ?? 0) / REJECTED_STRIDE;
    return allOf(count, (index) => ({ kind: "rejectedSegment", view, index }));
  },
  marks: ({ view: own, index }, { view, results }) =>
    own === view ? [{ points: endsIn(results.rejected[view], index, REJECTED_STRIDE), ...CHOSEN }] : [],
} satisfies Kind<"rejectedSegment">;

/** A place where a roof may be and the model has none. */
import { percentText } from "../../app/parts/numberText";
import { evidenceRow } from "../parts/evidenceRows";
import type { Kind } from "../parts/kind";
import { links, numbered } from "../parts/rows";
import { areas } from "../parts/shapes";

export default {
  title: "Place without a facet",
  rows({ index }, { results: { uncovered } }) {
    const roof = uncovered?.[index];
    if (roof === undefined) {
      return [];
    }
    const { why, area_m2, probability } = roof;
    const rejected = why === "no_plane" ? null : why.rejected;
    return [
      ["Probability of a roof", percentText(probability)],
      rejected === null
        ? ["No facet, because", "no plane won the place"]
        : links("Rejected as improbable", "rejectedFacet", [rejected.facet]),
      rejected !== null && evidenceRow("For and against it (nats)", rejected.evidence),
      ["Area in plan", `${area_m2.toFixed(1)} m²`, "that no facet covers"],
    ];
  },
  siblings: (_, { results: { uncovered } }) => numbered("uncoveredRoof", uncovered?.length),
  shapes: ({ index }, { uncovered }) => areas([uncovered?.[index]?.outline ?? []]),
} satisfies Kind<"uncoveredRoof">;

/** A facet that was rejected (B99 4.3). */
import { facetRejectionWords } from "../../app/parts/reasonText";
import { areaVector, norm } from "../../shared/linear";
import { evidenceRow } from "../parts/evidenceRows";
import type { Kind } from "../parts/kind";
import { numbered, numberRow, slopeText } from "../parts/rows";
import { areas } from "../parts/shapes";

export default {
  title: "Rejected facet",
  rows({ index }, { results: { verification } }) {
    const facet = verification?.rejected[index];
    if (facet === undefined) {
      return [];
    }
    const { reason, group, outline } = facet;
    const area = areaVector(outline);
    return [
      ["Rejected", facetRejectionWords(reason)],
      "improbable" in reason && evidenceRow("For and against it (nats)", reason.improbable.evidence),
      group !== undefined && numberRow("Group", group),
      ["Area", `${norm(area).toFixed(1)} m²`],
      ["Slope", slopeText(area)],
      ["Corners", String(outline.length)],
    ];
  },
  siblings: (_, { results: { verification } }) => numbered("rejectedFacet", verification?.rejected.length),
  shapes: ({ index }, { verification }) => areas([verification?.rejected[index]?.outline ?? []]),
} satisfies Kind<"rejectedFacet">;

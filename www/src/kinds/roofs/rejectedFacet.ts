/** A facet that was rejected (B99 4.3). */
import { facetRejectionWords } from "../../app/parts/reasonText";
import type { Vec3 } from "../../shared/records";
import { evidenceRow } from "../parts/evidenceRows";
import type { Kind } from "../parts/kind";
import { numbered, slopeText } from "../parts/rows";
import { areas } from "../parts/shapes";

export default {
  title: ({ index }) => `Rejected facet ${index}`,
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
      group !== undefined && ["Group", String(group)],
      ["Area", `${Math.hypot(...area).toFixed(1)} m²`],
      ["Slope", slopeText(area)],
      ["Corners", String(outline.length)],
    ];
  },
  siblings: (_, { results: { verification } }) => numbered("rejectedFacet", verification?.rejected.length),
  shapes: ({ index }, { verification }) => areas([verification?.rejected[index]?.outline ?? []]),
} satisfies Kind<"rejectedFacet">;

/** Normal of a ring, as long as its area is large. */
function areaVector(ring: readonly Vec3[]): Vec3 {
  const [ox, oy, oz] = ring[0] ?? [0, 0, 0];
  const sum: [number, number, number] = [0, 0, 0];
  ring.forEach(([px, py, pz], i) => {
    const [qx, qy, qz] = ring[(i + 1) % ring.length] as Vec3;
    const [ax, ay, az, bx, by, bz] = [px - ox, py - oy, pz - oz, qx - ox, qy - oy, qz - oz];
    sum[0] += (ay * bz - az * by) / 2;
    sum[1] += (az * bx - ax * bz) / 2;
    sum[2] += (ax * by - ay * bx) / 2;
  });
  return sum;
}

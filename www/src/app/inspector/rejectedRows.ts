/** What was rejected, in numbers: lines of edgels (B99 3.2), facets (B99 4.3) and clusters (W96 3.5). */
import { REJECTED_STRIDE } from "../../shared/flatArrays";
import type { Vec3 } from "../../shared/records";
import { degreesOf } from "../parts/numberText";
import { facetRejectionWords } from "../parts/reasonText";
import { results } from "../state/results";
import { evidenceRow } from "./evidenceRows";
import type { Row } from "./rowLinks";

/** By the core's numbers for them. */
const SEGMENT_REASONS = [
  "it is part of a curve",
  "the texture around it explains it",
  "a bar beside an edge that is a segment already",
];

export function rejectedSegmentRows(view: number, index: number): Row[] {
  const at = index * REJECTED_STRIDE;
  const [x0, y0, x1, y1, reason] = results.value.rejected[view]?.subarray(at, at + REJECTED_STRIDE) ?? [];
  if (x0 === undefined || y0 === undefined || x1 === undefined || y1 === undefined) {
    return [];
  }
  return [
    ["Length", `${Math.hypot(x1 - x0, y1 - y0).toFixed(1)} px`],
    ["Start", `${x0.toFixed(2)}, ${y0.toFixed(2)} px`],
    ["End", `${x1.toFixed(2)}, ${y1.toFixed(2)} px`],
    ["Rejected", SEGMENT_REASONS[reason ?? -1] ?? "unknown"],
  ];
}

export function rejectedFacetRows(index: number): Row[] {
  const facet = results.value.verification?.rejected[index];
  if (facet === undefined) {
    return [];
  }
  const [x, y, z] = areaVector(facet.outline);
  return [
    ["Rejected", facetRejectionWords(facet.reason)],
    ...("improbable" in facet.reason
      ? evidenceRow("For and against it (nats)", facet.reason.improbable.evidence)
      : []),
    ...(facet.group === undefined ? [] : [["Group", String(facet.group)] as const]),
    ["Area", `${Math.hypot(x, y, z).toFixed(1)} m²`],
    ["Slope", `${degreesOf(Math.atan2(Math.hypot(x, y), Math.abs(z))).toFixed(1)}°`],
    ["Corners", String(facet.outline.length)],
  ];
}

export function rejectedClusterRows(plane: number, index: number): Row[] {
  const trace = results.value.clusters?.[plane];
  const found = trace?.refused[index];
  if (trace === undefined || found === undefined) {
    return [];
  }
  const [[across, height], gain] = found;
  return [
    ["Across", `${across.toFixed(2)} m`],
    ["Height", `${height.toFixed(2)} m`],
    ["Along", `${degreesOf(trace.azimuth).toFixed(1)}° from X towards Y`],
    ["Gain G", `${gain.toFixed(1)} bit`],
    ["Rejected", gain > 0 ? "better clusters need its image lines" : "it does not shorten the description"],
  ];
}

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

/** Roof planes that were looked for and have no facet in the model: what is missing is said. */

import type { Facet, RejectedFacet, Vec3 } from "../../../shared/records";
import { natsOf } from "../../parts/reasonText";

/** Odds from which on a rejected facet may be a roof all the same: one in ten. */
const MAY_BE_ROOF_NATS = -Math.log(9);

function mayBeRoof({ reason }: RejectedFacet): boolean {
  return "improbable" in reason && natsOf(reason.improbable.evidence) >= MAY_BE_ROOF_NATS;
}

/** Indices of the rejected facets that may be roof and are not covered by the model, the largest first. */
export function unmodelledPlanes(rejected: readonly RejectedFacet[], facets: readonly Facet[]): number[] {
  const covered: (readonly Vec3[])[] = facets.map(({ outer }) => outer);
  const largestFirst = rejected
    .map((facet, index) => ({
      facet,
      outline: facet.outline,
      index,
      area: Math.abs(planArea(facet.outline)),
    }))
    .filter(({ facet }) => mayBeRoof(facet))
    .sort((a, b) => b.area - a.area);
  const found: number[] = [];
  for (const { outline, index } of largestFirst) {
    const middle = centroid(outline);
    // Several rejected planes at one place are one missing roof side.
    if (!covered.some((ring) => isInside(middle, ring))) {
      found.push(index);
      covered.push(outline);
    }
  }
  return found;
}

function planArea(ring: readonly Vec3[]): number {
  return edgesOf(ring).reduce((sum, [a, b]) => sum + (a[0] * b[1] - b[0] * a[1]) / 2, 0);
}

function centroid(ring: readonly Vec3[]): Vec3 {
  const mean = (axis: number) => ring.reduce((sum, point) => sum + (point[axis] as number), 0) / ring.length;
  return [mean(0), mean(1), mean(2)];
}

/** In plan, by the number of edges to the right. */
function isInside([x, y]: Vec3, ring: readonly Vec3[]): boolean {
  const crossed = edgesOf(ring).filter(
    ([a, b]) => a[1] > y !== b[1] > y && x < a[0] + ((y - a[1]) * (b[0] - a[0])) / (b[1] - a[1]),
  );
  return crossed.length % 2 === 1;
}

function edgesOf(ring: readonly Vec3[]): (readonly [Vec3, Vec3])[] {
  return ring.map((point, i) => [point, ring[(i + 1) % ring.length] as Vec3] as const);
}

/** A plane of dense matching (B99 2), for the inspector. */
import { type DensePlane, densePlanesOf } from "../../shared/records";
import { CLASSES, gradientOf } from "../../shared/surfaceClass";
import { degreesOf, percentText, slopeOf } from "../parts/numberText";
import { results } from "../state/results";
import { evidenceRow } from "./evidenceRows";
import { indicesOf, linkToFacet, linkToGroup, type Row } from "./rowLinks";

export function densePlaneRows(index: number): Row[] {
  const { dense, grouping, facets } = results.value;
  const plane = dense?.planes[index];
  if (dense === null || plane === undefined) {
    return [];
  }
  const own = plane.patches.flatMap((patch) => dense.trace.patches[patch] ?? []);
  const correlation = own.reduce((sum, one) => sum + one.correlation / own.length, 0);
  const evidence = dense.trace.classes[index];
  const has = (one: Parameters<typeof densePlanesOf>[0]) => densePlanesOf(one).includes(index);
  return [
    ["It is", CLASSES.map((name) => `${name} ${percentText(plane.class[name])}`).join(", ")],
    ["Area in plan", `${plane.area_m2.toFixed(1)} m²`],
    ["Slope", `${degreesText(slopeOf(plane.plane.normal))} ± ${degreesText(slopeSigma(plane))}`],
    ["σ of its height", centimetres(Math.sqrt(plane.covariance[0][0])), "in its middle"],
    ["RMS of its patches", centimetres(plane.rms_m), "above and below it"],
    ["Patches", String(plane.patches.length)],
    ["Mean correlation", correlation.toFixed(2)],
    ...evidenceRow("For and against a building (nats)", evidence?.building),
    ...evidenceRow("For vegetation, against ground (nats)", evidence?.vegetation),
    ...(grouping === null ? [] : [["Groups", indicesOf(grouping.groups, has).map(linkToGroup)] as const]),
    ...(facets === null ? [] : [["Facets", indicesOf(facets, has).map(linkToFacet)] as const]),
  ];
}

/** Standard deviation of a plane's slope, radians, from that of its gradient; of a level one along x or y, whichever is larger. */
export function slopeSigma(plane: Pick<DensePlane, "plane" | "covariance">): number {
  const [gx, gy] = gradientOf(plane);
  const rise = Math.hypot(gx, gy);
  const [, [, xx, xy], [, , yy]] = plane.covariance;
  const along = rise === 0 ? Math.max(xx, yy) : (gx * gx * xx + 2 * gx * gy * xy + gy * gy * yy) / rise ** 2;
  return Math.sqrt(along) / (1 + rise ** 2);
}

const degreesText = (radians: number) => `${degreesOf(radians).toFixed(1)}°`;
const centimetres = (metres: number) => `${(100 * metres).toFixed(1)} cm`;

/** A plane of dense matching (B99 2). */
import { percentText } from "../../app/parts/numberText";
import { densePlanesOf } from "../../shared/records";
import { CLASSES, slopeSigma } from "../../shared/surfaceClass";
import { evidenceRow } from "../parts/evidenceRows";
import type { Kind } from "../parts/kind";
import { degreesText, groupsAndFacets, numbered, slopeText } from "../parts/rows";
import { areas } from "../parts/shapes";

export default {
  title: "Dense plane",
  rows({ index }, { results }) {
    const { dense } = results;
    const plane = dense?.planes[index];
    if (dense === null || plane === undefined) {
      return [];
    }
    const own = plane.patches.flatMap((patch) => dense.trace.patches[patch] ?? []);
    const correlation = own.reduce((sum, one) => sum + one.correlation / own.length, 0);
    const evidence = dense.trace.classes[index];
    const centimetres = (metres: number) => `${(100 * metres).toFixed(1)} cm`;
    return [
      ["It is", CLASSES.map((name) => `${name} ${percentText(plane.class[name])}`).join(", ")],
      ["Area in plan", `${plane.area_m2.toFixed(1)} m²`],
      ["Slope", `${slopeText(plane.plane.normal)} ± ${degreesText(slopeSigma(plane))}`],
      ["σ of its height", centimetres(Math.sqrt(plane.covariance[0][0])), "in its middle"],
      ["RMS of its patches", centimetres(plane.rms_m), "above and below it"],
      ["Patches", String(plane.patches.length)],
      ["Mean correlation", correlation.toFixed(2)],
      evidenceRow("For and against a building (nats)", evidence?.building),
      evidenceRow("For vegetation, against ground (nats)", evidence?.vegetation),
      ...groupsAndFacets(results, (one) => densePlanesOf(one).includes(index)),
    ];
  },
  siblings: (_, { results: { dense } }) => numbered("dense", dense?.planes.length),
  shapes: ({ index }, { dense }) => areas([dense?.planes[index]?.ring ?? []]),
} satisfies Kind<"dense">;

/** A set of coplanar lines and its polygon (B99 2). */
import { coplanarSetsOf } from "../../shared/records";
import { slopeSigma } from "../../shared/surfaceClass";
import type { Kind } from "../parts/kind";
import { degreesText, groupsAndFacets, links, numbered, slopeText } from "../parts/rows";
import { areas } from "../parts/shapes";

export default {
  title: "Coplanar set",
  rows({ index }, { results }) {
    const set = results.coplanar?.sets[index];
    const trace = results.coplanar?.trace.sets[index];
    if (set === undefined || trace === undefined) {
      return [];
    }
    const nats = set.inside_nats + set.outline_nats;
    const closing = trace.closing.map((one) => ({
      name: one.kind === "square" ? "side made square" : "side mirrored",
      nats: one.nats,
    }));
    return [
      ["Verified", nats > 0 ? "yes" : "no", `${nats.toFixed(1)} nats for it`],
      links("3D lines", "line", set.lines),
      [
        "For and against it (nats)",
        {
          bars: [
            { name: "ends of its lines in one plane", nats: set.coplanar_nats },
            { name: "views agree inside", nats: set.inside_nats },
            { name: "outline, as far as no view shows it", nats: set.outline_nats },
          ],
        },
      ],
      ["Slope", `${slopeText(set.plane.normal)} ± ${degreesText(slopeSigma(set))}`],
      closing.length > 0 && ["Sides without a line (nats)", { bars: closing }],
      ...groupsAndFacets(results, (one) => coplanarSetsOf(one).includes(index)),
    ];
  },
  siblings: (_, { results: { coplanar } }) => numbered("coplanar", coplanar?.sets.length),
  /** Its polygon, over the hull that it was made from. */
  shapes({ index }, { coplanar }) {
    const set = coplanar?.sets[index];
    return set === undefined ? [] : [{ points: set.hull, role: "before" }, ...areas([set.polygon])];
  },
  lines: ({ index }, { coplanar }) => coplanar?.sets[index]?.lines ?? [],
} satisfies Kind<"coplanar">;

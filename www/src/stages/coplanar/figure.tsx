/** Sets of coplanar lines and their polygons. */
import { isVerifiedSet } from "../../shared/proposed";
import { highest } from "../highest";
import type { StageFigure } from "../stageFigure";
import { CoplanarLab } from "./CoplanarLab";

export default {
  title: "Coplanar sets",
  source: "B99 2 (Leuven; Moons et al. 1998), 5",
  text: "Lines in one plane are a face of the roof before anything is compared on it. Neighbouring lines are grouped where their ends, as uncertain as they are, more likely lie in one plane than not; the convex hull of the ends is the first polygon. A side without a line may be square to its neighbours, as the share P of the corners of true roofs is, or mirror the one across: c is how far an end is from that, φ the density of the ends' errors, w the length of its side. Then the views verify what is inside.",
  equation: ["ln ( w φ ( c ) ) + ln frac { P } { 1 - P } > 0"],
  hint: "Pick a polygon: its hull, its lines and its place in every photograph appear, and the inspector weighs each side.",

  rows: ({ results: { coplanar } }) =>
    (coplanar?.sets ?? []).flatMap((set, index) =>
      set.polygon.map(([x, y, z], corner) => ({
        set: index,
        corner,
        x,
        y,
        z,
        lines: set.lines.length,
        coplanar_nats: set.coplanar_nats,
        inside_nats: set.inside_nats,
        outline_nats: set.outline_nats,
        verified: isVerifiedSet(set),
      })),
    ),
  Lab: CoplanarLab,
  legend: () => [
    ["grown", "dashed: hull of the lines"],
    ["set", "polygon; one colour a set"],
    ["unmatched", "thin: not verified"],
  ],
  kinds: {
    "coplanar-sets": {
      View: CoplanarLab,
      // Of the sets that the photographs verify, that of which they say most for its outline.
      begin: ({ results: { coplanar } }) =>
        highest("coplanar", coplanar?.sets, (set) =>
          isVerifiedSet(set) ? Math.max(0, set.outline_nats) : 0,
        ),
    },
  },
} satisfies StageFigure;

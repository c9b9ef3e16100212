/** Planes of dense matching. */
import type { LegendEntry } from "../../app/parts/Legend";
import { planeOf } from "../../app/results/takeAlong/rows";
import { CLASSES, type ClassName, likeliestClass } from "../../shared/surfaceClass";
import { highest } from "../highest";
import { faintEntry } from "../lines/lineLegend";
import type { StageFigure } from "../stageFigure";
import { DenseLab } from "./DenseLab";

export default {
  title: "Dense planes",
  source: "B99 2 (ENST); Barnes et al. 2009; Bleyer et al. 2011; Isack and Boykov 2012",
  text: "Where no line starts a plane, the photographs themselves do. On a grid in plan, small slanted patches try the planes of their neighbours and variations of their own, and keep the one on which the views agree best (PatchMatch). The planes of patches that fit together then compete (PEaRL): each patch p gets the plane l for which the views say most, N in nats, or none; neighbours p and q with different planes cost β. Height, roughness, colour and size say what a plane is.",
  equation: ["max _ l sum _ p N _ p ( l _ p ) - β sum _ { p , q } [ l _ p ≠ l _ q ]"],
  hint: "Pick a patch: its plane lights up, and stems lead to the heights that its patches had by themselves. The inspector says what speaks for a building and against it.",

  rows: ({ results: { dense } }) =>
    (dense?.planes ?? []).map(({ plane, patches, ...of }, index) => ({
      plane: index,
      ...planeOf(plane),
      patches: patches.length,
      class: likeliestClass(of.class).name,
      probability: likeliestClass(of.class).probability,
    })),
  Lab: DenseLab,
  // The classes that there are, and whether there are patches in no plane.
  legend: ({ results: { dense } }) => {
    const { planes, trace } = dense ?? { planes: [], trace: null };
    const found = planes.map((plane) => likeliestClass(plane.class));
    const names = new Set<ClassName>(found.map(({ name }) => name));
    const inPlanes = planes.reduce((sum, { patches }) => sum + patches.length, 0);
    return [
      ...CLASSES.filter((name) => names.has(name)).map((name): LegendEntry => [`class-${name}`, name]),
      ...((trace?.patches.length ?? 0) > inPlanes ? [["unmatched", "small: in no plane"] as const] : []),
      ...faintEntry(found),
    ];
  },
  kinds: {
    "dense-planes": {
      View: DenseLab,
      // The largest building.
      begin: ({ results: { dense } }) =>
        highest("dense", dense?.planes, (plane) => plane.class.building * plane.patches.length),
    },
  },
} satisfies StageFigure;

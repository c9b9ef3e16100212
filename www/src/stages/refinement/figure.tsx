/** What refinement made of the buildings. */
import { highest } from "../highest";
import { faintEntry } from "../lines/lineLegend";
import type { StageFigure } from "../stageFigure";
import { RefinementLab } from "./RefinementLab";

export default {
  title: "Regularisation and refinement",
  source: "B99 2",
  text: "All sides of a building are measured again in every view that sees them, and its planes and corners are adjusted together until the wireframe fits the edges. What roofs mostly are (level, parallel, square, symmetric) is tested one by one: c is how far the free solution is from it. A relation that the images allow is adopted and holds exactly.",
  equation: ["χ ^2 = frac { c ^2 } { J C J ^T + σ ^2 }"],
  hint: "Orange: outlines before refinement. Pick a dot: its sides light up in space and in every view; what lies left of the dashed line is adopted.",

  rows: ({ results: { refinement } }) =>
    (refinement?.buildings ?? []).flatMap(({ relations }, building) =>
      relations.map(({ kind, deviation_m, chi2, adopted }) => ({
        building,
        kind,
        deviation_m,
        chi2,
        adopted,
      })),
    ),
  Lab: RefinementLab,
  legend: ({ results: { facets } }) => [
    ["grown", "outline before refinement"],
    ["border-inplane", "side in an adopted relation"],
    ["rejected", "rejected; gap in the outline"],
    ...faintEntry(facets),
  ],
  kinds: {
    refinement: {
      View: RefinementLab,
      // The building with the most relations.
      begin: ({ results: { refinement } }) =>
        highest("refinement", refinement?.buildings, ({ relations }) => relations.length),
    },
  },
} satisfies StageFigure;

/** The facets, and the border lines that enclose them. */
import { faintEntry } from "../lines/lineLegend";
import type { StageFigure } from "../stageFigure";
import { FacetLab } from "./FacetLab";
import { facetRows } from "./facetRows";

export default {
  title: "Facets",
  source: "B99 4.3, figures 21 to 23",
  text: "[[border-line|Border lines]] (real lines, new lines, intersections of planes, closing lines) cut the plan into cells, and the planes compete for them. A facet is kept if the views agree inside and enough of its outline, τ, is real. The paper settles conflicts pair by pair, by area times that share; here the same evidence decides for all cells at once.",
  equation: ["S = A * τ _ real"],
  hint: "Hue: where a facet faces; saturation: how steep it is. Red outlines in the plan were rejected.",

  rows: facetRows,
  Lab: FacetLab,
  legend: ({ results: { facets } }) => [
    ["normals", "hue: azimuth, saturation: slope"],
    ...faintEntry(facets),
  ],
  kinds: {
    "facet-plan": {
      View: FacetLab,
      begin: ({ results: { facets } }) =>
        facets === null || facets.length === 0 ? null : { kind: "facet", index: 0 },
    },
  },
} satisfies StageFigure;

/** The 3D lines, and how accurate they are. */
import { endsOf } from "../../app/results/takeAlong/rows";
import type { Selection } from "../../shared/selection";
import type { Figure } from "../figure";
import type { StageFigure } from "../stageFigure";
import { LineLab } from "./LineLab";
import { contradictedEntry, faintEntry, lineEntries, standingLines } from "./lineLegend";

export default {
  title: "3D lines",
  source: "B99 3.2 to 3.4, figures 4, 6, 8 and 9",
  text: "A line L has four parameters. They minimise the distances d from the ends of the measured segments (m) to the image of L, over all views j. Merging and growing extend what the segments showed. [[triangulation|Accuracy]] improves with the number of views.",
  equation: ["min _ L sum _ j d ^2 ( vec l _ m ^j , vec l ^j )"],
  hint: "Before growing shows what the segments alone give. The fainter a line, the less certain it is; pick it to see what speaks for it and against it. Red lines are too unlikely edges in the finished model, or a better line runs along them: the files leave them out.",

  rows: ({ results: { records, lines } }) =>
    records.map(({ origin, probability, sigma_m, supports }, line) => ({
      line,
      origin,
      ...endsOf(lines, line),
      views: supports.length,
      sigma_m,
      probability,
    })),
  Lab: LineLab,
  legend: ({ results, beforeGrowing }) =>
    beforeGrowing
      ? [["matched", "matched"]]
      : [...lineEntries(results), ...faintEntry(standingLines(results)), ...contradictedEntry(results)],
  kinds: { "line-accuracy": { View: LineLab, begin: bestLine } },
} satisfies StageFigure;

/** The matched line of most views; of several, the most accurate. */
function bestLine({ results: { records } }: Figure): Selection | null {
  const order = records
    .map(({ supports, sigma_m, origin }, index) => ({ index, views: supports.length, sigma_m, origin }))
    .filter(({ origin }) => origin === "matched")
    .sort((a, b) => b.views - a.views || a.sigma_m - b.sigma_m);
  return order[0] === undefined ? null : { kind: "line", index: order[0].index };
}

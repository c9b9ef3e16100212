/** Planes between parallel lines. */
import type { StageFigure } from "../stageFigure";
import { RectangleLab } from "./RectangleLab";

export default {
  title: "Rectangular planes",
  source: "W96 3.6, figures 10 to 12",
  text: "Two parallel lines span a plane that is open at two ends. Image lines that cross it at right angles vote for their position along it; the histogram's peaks are its ends. The set S of planes p that do not overlap, with the largest sum of measures M, is the roof.",
  equation: ["max _ S sum _ { p ∈ S } M ( p )"],
  hint: "Pick a facet or choose a pair of lines to see its window.",

  rows: ({ results: { rectangles } }) =>
    (rectangles?.pairs ?? []).map(({ lines: [first, second], rejection, crossings, ends }) => ({
      first,
      second,
      rejection,
      crossings: crossings.length,
      ends: ends.length,
    })),
  Lab: RectangleLab,
  legend: () => [
    ["normals", "hue: azimuth, saturation: slope"],
    ["plane-end", "end of a plane"],
  ],
  kinds: { rectangles: { View: RectangleLab } },
} satisfies StageFigure;

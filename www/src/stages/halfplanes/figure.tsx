/** Half-planes at the 3D lines, and Sim(theta) of each. */
import { degreesOf } from "../../app/parts/numberText";
import type { Row } from "../../app/results/takeAlong/rows";
import type { Selection } from "../../shared/selection";
import { type Figure, viewName } from "../figure";
import { highest } from "../highest";
import { faintEntry, hasContradicted, lineEntries, standingLines } from "../lines/lineLegend";
import type { StageFigure } from "../stageFigure";
import { SimLab } from "./SimLab";

export default {
  title: "Half-planes",
  source: "B99 4.1, figures 10 to 15",
  text: "A 3D line fixes the plane through it except for one angle, θ. Each θ induces a [[homography]] between the reference view [I | 0] and view i, [A | a]; v is the plane's normal over its distance. At the right θ the neighbourhoods agree: [[similarity|Sim(θ)]] averages the squared correlations at points of interest, weighted by w, the inverse of their distance from the line, over the views that see the side.",
  equation: [
    "H ^i ( θ ) = A ^i + vec a ^i vec v ^T ( θ )",
    "Sim ( θ ) = sum _ i ∫ _ POI w ( vec x )",
    "* Cor ^2 ( vec x , H ^i ( θ ) vec x )",
  ],
  hint: "Pick a line or a fan, then drag θ: the windows below are alike only at the right angle.",

  rows: similarityRows,
  Lab: SimLab,
  legend: ({ results }) => [
    ...lineEntries(results).map(([colour, what]) => [colour, what === "matched" ? "3D line" : what] as const),
    ...faintEntry(standingLines(results)),
    ["half-plane", "half-plane"],
    ["rejected", hasContradicted(results) ? "rejected side, contradicted line" : "rejected side"],
  ],
  kinds: { "theta-sweep": { View: SimLab, begin: sharpestHalfPlane } },
} satisfies StageFigure;

/** Sim(theta) of the picked side, and of each view by itself. */
function similarityRows(figure: Figure): Row[] {
  const { thetas, similarity, views } = figure.detail.side?.curve ?? {
    thetas: [],
    similarity: [],
    views: [],
  };
  return thetas.map((theta, i) => ({
    theta_deg: degreesOf(theta),
    sim: similarity[i] ?? null,
    ...Object.fromEntries(
      views.map((one) => [`sim_${viewName(figure, one.view)}`, one.similarity[i] ?? null]),
    ),
  }));
}

/** The half-plane with the highest and sharpest peak. */
function sharpestHalfPlane({ results: { halfPlanes } }: Figure): Selection | null {
  // A slope shows more than a level roof, on which all angles begin.
  const ofSlope = (theta: number) => (Math.abs(theta) > 0.2 ? 2 : 1);
  return highest(
    "halfplane",
    halfPlanes,
    ({ probability, amplitude, similarity, theta }) => probability * amplitude * similarity * ofSlope(theta),
  );
}

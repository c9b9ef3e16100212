/** Clusters of image lines in the planes across the main directions. */
import type { Row } from "../../app/results/takeAlong/rows";
import type { Figure } from "../figure";
import type { StageFigure } from "../stageFigure";
import { ClusterLab } from "./ClusterLab";

export default {
  title: "Clusters",
  source: "W96 3.5, figures 6 to 9",
  text: "In the plane across a [[main-direction]], each image line of that direction is a straight line, and a 3D line is a point where lines of several images meet. The points compete by description length: G is by how many bits the description of the image lines gets shorter when they share one [[cluster]]. Colours are views.",
  equation: ["G = L _ alone - L _ cluster > 0"],
  hint: "Pick a ring: its 3D line is projected back into every view. Small red rings were rejected.",

  rows: clusterRows,
  overlay: (view, { results: { segments, supports } }) => ({
    segments: segments[view] ?? null,
    supports: supports[view] ?? null,
  }),
  Lab: ClusterLab,
  legend: () => [
    ["unmatched", "region boundary"],
    ["matched", "3D line"],
  ],
  kinds: { clusters: { View: ClusterLab } },
} satisfies StageFigure;

function clusterRows({ results: { clusters }, plane }: Figure): Row[] {
  const { selected = [], refused = [] } = clusters?.[plane] ?? {};
  return [
    ...selected.map(([[across_m, height_m], gain_bit]) => ({ across_m, height_m, gain_bit, selected: true })),
    ...refused.map(([[across_m, height_m]]) => ({ across_m, height_m, gain_bit: null, selected: false })),
  ];
}

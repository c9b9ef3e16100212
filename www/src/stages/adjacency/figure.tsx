/** Adjacency graphs of the images, and corners in space. */
import { highest } from "../highest";
import type { StageFigure } from "../stageFigure";
import { AdjacencyLab } from "./AdjacencyLab";

export default {
  title: "Adjacency graphs",
  source: "B99 2 (Bonn; Fischer et al. 1998)",
  text: "Ends of segments that more likely meet than lie beside each other by chance make corners; their edges, in order around each, part the image into regions: an [[adjacency-graph]]. A corner is matched over the views as a whole: N is what the distance from its epipolar line or its predicted place says (covariance S), what the directions of its edges say, and the colours of its regions, each against the density ρ of such things by chance. Two edges in space with a region between them propose its plane; corners that an edge joins confirm each other.",
  equation: ["N = sum _ j ln frac { φ ( vec x _ j - P _ j vec X ; S _ j ) } { ρ _ j } > 0"],
  hint: "Pick a large dot in the image: its edges light up in all views, with the planes of the regions between them.",

  rows: ({ results: { adjacency } }) =>
    (adjacency?.trace.corners ?? []).map(({ at: [x, y, z], images, edges }, corner) => ({
      corner,
      x,
      y,
      z,
      views: images.length,
      edges: edges.length,
    })),
  Lab: AdjacencyLab,
  legend: () => [
    ["matched", "edge of a corner in space"],
    ["unmatched", "edge seen in one view"],
    ["set", "region; plane of regions"],
  ],
  kinds: {
    adjacency: {
      View: AdjacencyLab,
      // The corner with the most edges in the most views.
      begin: ({ results: { adjacency } }) =>
        highest("corner", adjacency?.trace.corners, ({ edges, images }) => edges.length * images.length),
    },
  },
} satisfies StageFigure;

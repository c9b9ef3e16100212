/** The photographs with their cameras. */
import type { StageFigure } from "../stageFigure";

export default {
  title: "Views",
  source: "B99 2, figure 1; W96 3.2",
  text: "Each view is a photograph with a known camera P. Lens distortion has been removed, so that a point X, seen from the [[projection-centre]] C, lies at x ≃ P X: both are homogeneous, so the scale is free. All later figures rest on this one equation.",
  equation: ["vec x ~ P vec X = K R ( vec X - vec C )"],
  hint: "Scroll to zoom, drag to move. What is selected elsewhere is marked here.",

  /** The cameras: centre, and the projection matrix row by row. */
  rows: ({ scene }) =>
    (scene?.views ?? []).map(({ name, width, height, center: [x, y, z], projection }) => ({
      view: name,
      width,
      height,
      x,
      y,
      z,
      ...Object.fromEntries(
        [...projection].map((value, i) => [`p${Math.floor(i / 4) + 1}${(i % 4) + 1}`, value]),
      ),
    })),
} satisfies StageFigure;

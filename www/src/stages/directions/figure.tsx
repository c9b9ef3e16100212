/** The main directions, and the image lines that follow them. */
import type { Overlay } from "../../app/view/images/drawing";
import { PickedImage } from "../../app/view/images/ImageRow";
import type { Figure } from "../figure";
import type { StageFigure } from "../stageFigure";
import { DirectionLab } from "./DirectionLab";
import { directionColours } from "./directionColours";

export default {
  title: "Main directions",
  source: "W96 3.4, figures 4 and 5",
  text: "The [[interpretation-plane]] of every image line is cut with the XY plane. Horizontal lines give the same azimuth α from every view; others scatter. Two perpendicular peaks of the histogram h are found together.",
  equation: ["max _ α h ( α ) + h ( α + 90° )"],
  hint: "Blue and orange lines may follow the first and the second direction.",

  /** The histogram of azimuths of the building that is shown. */
  rows: ({ results: { directions }, plane }) => {
    const found = directions?.trace.histograms[plane];
    return (found?.histogram ?? []).map((weight, bin) => ({
      azimuth_deg: (bin + 0.5) * (found?.bin_deg ?? 1),
      weight,
    }));
  },
  overlay,
  Lab: DirectionLab,
  legend: () => [
    ["first-direction", "first direction"],
    ["second-direction", "second direction"],
    ["unmatched", "neither"],
  ],
  kinds: {
    "main-directions": {
      View: ({ figure }) => (
        <div class="over-lab">
          <PickedImage figure={figure} overlay={overlay} />
          <DirectionLab figure={figure} />
        </div>
      ),
    },
  },
} satisfies StageFigure;

function overlay(view: number, figure: Figure): Overlay {
  const segments = figure.results.segments[view] ?? null;
  return { segments, supports: null, colours: directionColours(view, figure) };
}

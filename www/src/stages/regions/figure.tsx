/** The regions of each view. */
import type { Overlay } from "../../app/view/images/drawing";
import { PickedImage } from "../../app/view/images/ImageRow";
import { category } from "../../shared/palette";
import type { Segmentation } from "../../shared/records";
import { type Figure, viewName } from "../figure";
import type { StageFigure } from "../stageFigure";

export default {
  title: "Regions (ORIS)",
  source: "W96 3.3, figure 3",
  text: "The image becomes a partition into [[region|regions]] of constant grey value plus noise, with straight shared boundaries. Break points are dropped and regions merged, always the move that shortens the [[description-length|description]] most: the length L of the model m and of what remains of the image I. It ends when no move does.",
  equation: ["min L ( m ) + L ( I | m )"],
  hint: "Pick a region for its area, mean and variance. Tints only distinguish neighbouring regions.",

  rows: (figure) =>
    figure.results.regions.flatMap(({ regions }, view) =>
      regions.map(({ mean, rings }, region) => ({
        view: viewName(figure, view),
        region,
        mean,
        corners: rings[0]?.length ?? 0,
      })),
    ),
  overlay,
  kinds: { regions: { View: ({ figure }) => <PickedImage figure={figure} overlay={overlay} /> } },
} satisfies StageFigure;

function overlay(view: number, { results }: Figure): Overlay {
  return { segments: null, supports: null, regions: regionsOf(results.regions[view]) };
}

/** The regions with colours that tell neighbours apart; made once for each segmentation. */
const tinted = new WeakMap<object, { rings: (readonly [number, number])[][]; colour: string }[]>();

function regionsOf(segmentation: Segmentation | undefined) {
  if (segmentation === undefined) {
    return null;
  }
  const known = tinted.get(segmentation);
  if (known !== undefined) {
    return known;
  }
  const made = segmentation.regions.map(({ rings, mean }, i) => ({
    rings: rings.map((ring) => [...ring]),
    colour: `color-mix(in oklab, ${category(i)} 45%, rgb(${mean}, ${mean}, ${mean}))`,
  }));
  tinted.set(segmentation, made);
  return made;
}

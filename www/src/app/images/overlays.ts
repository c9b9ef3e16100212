/** What the figure of a stage draws over a view. */

import { category } from "../../shared/palette";
import type { Figure, Results } from "../../stages/figure";
import type { Tab } from "../state/methods";
import { directionColours } from "./directionColours";
import type { Overlay } from "./drawing";

export function overlayOf(tab: Tab, view: number, figure: Figure, withRejected = false): Overlay {
  const { segments, supports, rejected, regions } = figure.results;
  const nothing: Overlay = { segments: null, supports: null };
  const own = segments[view] ?? null;
  switch (tab) {
    case "segments":
      return { ...nothing, segments: own, rejected: withRejected ? (rejected[view] ?? null) : null };
    case "matches":
      return { segments: own, supports: supports[view] ?? null, segmentsFirst: true };
    case "regions":
      return { ...nothing, regions: regionsOf(regions[view]) };
    case "directions":
      return { ...nothing, segments: own, colours: directionColours(view, figure) };
    case "clusters":
      return { segments: own, supports: supports[view] ?? null };
    default:
      return nothing;
  }
}

/** The regions with colours that tell neighbours apart; made once for each segmentation. */
const tinted = new WeakMap<object, { rings: (readonly [number, number])[][]; colour: string }[]>();

function regionsOf(segmentation: Results["regions"][number] | undefined) {
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

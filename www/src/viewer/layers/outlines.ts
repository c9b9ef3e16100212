/** The facets of a model that was kept for comparison: their outlines only, over whatever is shown. */
import { PALETTE } from "../../shared/palette";
import type { Facet } from "../../shared/records";
import { zUpGroup } from "../scene/frame";
import { type Layer, layerOf } from "../scene/layer";
import { sidesOf, strokes } from "../scene/strokes";

const WIDTH_PX = 3;

export function buildOutlines(facets: readonly Facet[]): Layer {
  const object = zUpGroup();
  const sides = sidesOf(facets.flatMap(({ outer, holes }) => [outer, ...holes]));
  const lines = strokes(sides, PALETTE.merged, WIDTH_PX);
  lines.material.depthTest = false;
  lines.renderOrder = 3;
  lines.raycast = () => undefined;
  object.add(lines);
  return layerOf(object);
}

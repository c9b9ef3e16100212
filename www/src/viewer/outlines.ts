/** The facets of a model that was kept for comparison: their outlines only, over whatever is shown. */
import { PALETTE } from "../shared/palette";
import type { Facet } from "../shared/results";
import { zUpGroup } from "./frame";
import { strokes } from "./groups";
import { disposeObject, type Layer } from "./layer";

const WIDTH_PX = 3;

export function buildOutlines(facets: readonly Facet[]): Layer {
  const object = zUpGroup();
  const positions: number[] = [];
  for (const ring of facets.flatMap(({ outer, holes }) => [outer, ...holes])) {
    ring.forEach((corner, i) => {
      positions.push(...corner, ...(ring[(i + 1) % ring.length] ?? corner));
    });
  }
  const lines = strokes(positions, new Array<string>(positions.length / 6).fill(PALETTE.merged), WIDTH_PX);
  lines.material.depthTest = false;
  lines.renderOrder = 3;
  lines.raycast = () => undefined;
  object.add(lines);
  return { object, pick: () => null, highlight: () => undefined, dispose: () => disposeObject(object) };
}

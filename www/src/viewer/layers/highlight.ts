/** The selected thing over whatever the view shows: it is seen in every tab, whether its own layer is there or not. */
import { PALETTE } from "../../shared/palette";
import type { Vec3 } from "../../shared/records";
import { zUpGroup } from "../scene/frame";
import { type Layer, layerOf } from "../scene/layer";
import { sidesOf, strokes } from "../scene/strokes";

const WIDTH_PX = 4;

interface Polyline {
  points: readonly Vec3[];
  closed: boolean;
}

export function buildHighlight(polylines: readonly Polyline[]): Layer {
  const object = zUpGroup();
  const sides = polylines.flatMap(({ points, closed }) => {
    const positions = sidesOf([points]);
    // The last side of an open line leads back to its start.
    return closed ? positions : positions.slice(0, -6);
  });
  if (sides.length > 0) {
    object.add(above(sides));
  }
  return layerOf(object);
}

function above(positions: readonly number[]) {
  const drawn = strokes(positions, PALETTE.selected, WIDTH_PX);
  drawn.material.depthTest = false;
  drawn.renderOrder = 4;
  drawn.raycast = () => undefined;
  return drawn;
}

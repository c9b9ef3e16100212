/**
 * Corners in space with their edges (B99 2: Bonn) and the planes of the regions between them; planes that the photographs do
 * not verify are thin and grey.
 */
import { Group } from "three";
import { category, PALETTE } from "../../shared/palette";
import { edgesOfCorner, isVerifiedPlane } from "../../shared/proposed";
import type { AdjacencyGraphs, CornerPlane, SpaceCorner } from "../../shared/records";
import type { Layer } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";
import { sidesOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = { edges: 2.5, polygon: 2, refused: 1, selected: 5 };
/** Alone, and while something is selected. */
const OPACITY = { edges: [1, 0.25], polygon: [0.9, 0.225], refused: [0.35, 0.0875] } as const;

export function buildAdjacency({ planes, trace }: AdjacencyGraphs): Layer {
  const { corners } = trace;
  const edges = corners.flatMap((corner, index) =>
    edgesOfCorner(corner, corners).map((ends) => ({ ends, index })),
  );
  const numbered = planes.map((plane, index) => ({ plane, index, corner: plane.regions[0]?.[0] ?? 0 }));
  const verified = numbered.filter(({ plane }) => isVerifiedPlane(plane));
  const refused = numbered.filter(({ plane }) => !isVerifiedPlane(plane));
  const sides = (of: typeof numbered) => of.flatMap((one) => one.plane.polygon.map(() => one));
  const rings = (of: typeof numbered) => sidesOf(of.map(({ plane }) => plane.polygon));
  const ends = edges.flatMap((one) => one.ends.flat());
  const colours = sides(verified).map(({ index }) => category(index));
  return partsLayer({
    kind: "corner",
    parts: [
      {
        drawn: strokes(ends, PALETTE.matched, WIDTH_PX.edges),
        opacity: OPACITY.edges,
        things: edges.map(({ index }) => index),
      },
      {
        drawn: strokes(rings(verified), colours, WIDTH_PX.polygon),
        opacity: OPACITY.polygon,
        things: sides(verified).map((one) => one.corner),
      },
      {
        drawn: strokes(rings(refused), PALETTE.unmatched, WIDTH_PX.refused),
        opacity: OPACITY.refused,
        things: sides(refused).map((one) => one.corner),
      },
    ],
    chosen: (picked) => {
      const corner = corners[picked];
      const own = planes.filter(({ regions }) => regions.some(([index]) => index === picked));
      return corner === undefined ? null : chosenCorner(corner, corners, own);
    },
  });
}

/** A corner's edges and the planes that it proposes, over all else. */
function chosenCorner(corner: SpaceCorner, corners: readonly SpaceCorner[], own: CornerPlane[]): Group {
  return new Group().add(
    strokes(sidesOf(own.map(({ polygon }) => polygon)), PALETTE.grown, WIDTH_PX.polygon),
    strokes(edgesOfCorner(corner, corners).flat(2), PALETTE.selected, WIDTH_PX.selected),
  );
}

/**
 * Corners in space with their edges (B99 2: Bonn) and the planes of the regions between them; planes that the photographs do
 * not verify are thin and grey.
 */
import { Group } from "three";
import { category, PALETTE } from "../../shared/palette";
import { edgesOfCorner, isVerifiedPlane } from "../../shared/proposed";
import type { AdjacencyGraphs, CornerPlane, SpaceCorner } from "../../shared/records";
import { pickedIndex, type Selection } from "../../shared/selection";
import { zUpGroup } from "../../viewer/scene/frame";
import { disposeObject, fade, type Layer } from "../../viewer/scene/layer";
import { SelectedObject } from "../../viewer/scene/selectedObject";
import { sidesOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = { edges: 2.5, polygon: 2, refused: 1, selected: 5 };
const OPACITY = { edges: 1, polygon: 0.9, refused: 0.35 };
/** Of everything but the selection. */
const DIMMED = 0.25;

export function buildAdjacency({ planes, trace }: AdjacencyGraphs): Layer {
  const object = zUpGroup();
  const { corners } = trace;
  const edges = corners.flatMap((corner, index) =>
    edgesOfCorner(corner, corners).map((ends) => ({ ends, index })),
  );
  const numbered = planes.map((plane, index) => ({ plane, index, corner: plane.regions[0]?.[0] ?? 0 }));
  const verified = numbered.filter(({ plane }) => isVerifiedPlane(plane));
  const refused = numbered.filter(({ plane }) => !isVerifiedPlane(plane));
  const sides = (of: typeof numbered) => of.flatMap((one) => one.plane.polygon.map(() => one));
  const rings = (of: typeof numbered) => sidesOf(of.map(({ plane }) => plane.polygon));
  const parts = {
    edges: strokes(
      edges.flatMap(({ ends }) => ends.flat()),
      PALETTE.matched,
      WIDTH_PX.edges,
    ),
    polygon: strokes(
      rings(verified),
      sides(verified).map(({ index }) => category(index)),
      WIDTH_PX.polygon,
    ),
    refused: strokes(rings(refused), PALETTE.unmatched, WIDTH_PX.refused),
  };
  const cornerOf = new Map<unknown, readonly number[]>([
    [parts.edges, edges.map(({ index }) => index)],
    [parts.polygon, sides(verified).map((one) => one.corner)],
    [parts.refused, sides(refused).map((one) => one.corner)],
  ]);
  object.add(...Object.values(parts));
  const chosen = new SelectedObject(object);
  return {
    object,
    pick: (hit) => {
      const index = cornerOf.get(hit.object)?.[hit.faceIndex ?? -1];
      return index === undefined ? null : { kind: "corner", index };
    },
    highlight(selection: Selection | null) {
      fade(parts, OPACITY, selection === null ? 1 : DIMMED);
      const picked = pickedIndex(selection, "corner");
      const corner = corners[picked];
      const own = planes.filter(({ regions }) => regions.some(([index]) => index === picked));
      chosen.show(corner === undefined ? null : chosenCorner(corner, corners, own));
    },
    dispose: () => disposeObject(object),
  };
}

/** A corner's edges and the planes that it proposes, over all else. */
function chosenCorner(corner: SpaceCorner, corners: readonly SpaceCorner[], own: CornerPlane[]): Group {
  return new Group().add(
    strokes(sidesOf(own.map(({ polygon }) => polygon)), PALETTE.grown, WIDTH_PX.polygon),
    strokes(edgesOfCorner(corner, corners).flat(2), PALETTE.selected, WIDTH_PX.selected),
  );
}

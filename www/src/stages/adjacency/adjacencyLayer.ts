/**
 * Corners in space with their edges (B99 2: Bonn) and the planes of the regions between them; planes that the photographs do
 * not verify are thin and grey.
 */
import { Group } from "three";
import { category, PALETTE } from "../../shared/palette";
import { edgesOfCorner, isVerifiedPlane } from "../../shared/proposed";
import type { AdjacencyGraphs, CornerPlane, SpaceCorner } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { zUpGroup } from "../../viewer/scene/frame";
import { disposeObject, type Layer } from "../../viewer/scene/layer";
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
  const corner = new Map<unknown, readonly number[]>([
    [parts.edges, edges.map(({ index }) => index)],
    [parts.polygon, sides(verified).map((one) => one.corner)],
    [parts.refused, sides(refused).map((one) => one.corner)],
  ]);
  object.add(...Object.values(parts));
  const chosen = new SelectedObject(object);
  return {
    object,
    pick: (hit) => {
      const index = corner.get(hit.object)?.[hit.faceIndex ?? -1];
      return index === undefined ? null : { kind: "corner", index };
    },
    highlight(selection: Selection | null) {
      for (const name of Object.keys(parts) as (keyof typeof parts)[]) {
        parts[name].material.opacity = OPACITY[name] * (selection === null ? 1 : DIMMED);
      }
      const picked = selection?.kind === "corner" ? corners[selection.index] : undefined;
      const own = planes.filter(({ regions }) =>
        regions.some(([index]) => selection?.kind === "corner" && index === selection.index),
      );
      chosen.show(picked === undefined ? null : chosenCorner(picked, corners, own));
    },
    dispose: () => disposeObject(object),
  };
}

/** A corner's edges and the planes that it proposes, over all else. */
function chosenCorner(corner: SpaceCorner, corners: readonly SpaceCorner[], own: CornerPlane[]): Group {
  const all = [
    strokes(sidesOf(own.map(({ polygon }) => polygon)), PALETTE.grown, WIDTH_PX.polygon),
    strokes(edgesOfCorner(corner, corners).flat(2), PALETTE.selected, WIDTH_PX.selected),
  ];
  for (const one of all) {
    one.raycast = () => undefined;
  }
  return new Group().add(...all);
}

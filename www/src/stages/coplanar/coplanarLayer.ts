/**
 * Sets of coplanar lines (B99 2): their polygons in colours of their own over the hulls that they were made from; sets that
 * the photographs do not verify are thin and grey.
 */
import { Group } from "three";
import { category, PALETTE } from "../../shared/palette";
import { isVerifiedSet } from "../../shared/proposed";
import type { CoplanarSet, CoplanarSets } from "../../shared/records";
import { pickedIndex, type Selection } from "../../shared/selection";
import { zUpGroup } from "../../viewer/scene/frame";
import { disposeObject, fade, type Layer } from "../../viewer/scene/layer";
import { SelectedObject } from "../../viewer/scene/selectedObject";
import { endsOf, sidesOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = { polygon: 3.5, hull: 1.5, refused: 1, line: 2, selected: 5 };
const OPACITY = { polygon: 1, hull: 0.8, refused: 0.35 };
/** Of everything but the selection. */
const DIMMED = 0.25;

/** @param lines p0 and p1 of each 3D line, local frame, metres */
export function buildCoplanar({ sets }: CoplanarSets, lines: Float64Array): Layer {
  const object = zUpGroup();
  const numbered = sets.map((set, index) => ({ set, index }));
  const verified = numbered.filter(({ set }) => isVerifiedSet(set));
  const refused = numbered.filter(({ set }) => !isVerifiedSet(set));
  // One entry a side: a click on a side picks its set.
  const sides = verified.flatMap(({ set, index }) => set.polygon.map(() => index));
  const parts = {
    polygon: strokes(
      sidesOf(verified.map(({ set }) => set.polygon)),
      sides.map((index) => category(index)),
      WIDTH_PX.polygon,
    ),
    hull: strokes(sidesOf(verified.map(({ set }) => set.hull)), PALETTE.grown, WIDTH_PX.hull),
    refused: strokes(sidesOf(refused.map(({ set }) => set.polygon)), PALETTE.unmatched, WIDTH_PX.refused),
  };
  const refusedSides = refused.flatMap(({ set, index }) => set.polygon.map(() => index));
  parts.hull.raycast = () => undefined;
  object.add(...Object.values(parts));
  const chosen = new SelectedObject(object);
  return {
    object,
    pick: (hit) => {
      const at = hit.faceIndex ?? -1;
      const of = hit.object === parts.polygon ? sides : hit.object === parts.refused ? refusedSides : [];
      const index = of[at];
      return index === undefined ? null : { kind: "coplanar", index };
    },
    highlight(selection: Selection | null) {
      fade(parts, OPACITY, selection === null ? 1 : DIMMED);
      const set = sets[pickedIndex(selection, "coplanar")];
      chosen.show(set === undefined ? null : chosenSet(set, lines));
    },
    dispose: () => disposeObject(object),
  };
}

/** A set's hull, its lines and its polygon, over all else. */
function chosenSet(set: CoplanarSet, lines: Float64Array): Group {
  const ends = set.lines.flatMap((line) => endsOf(lines, line));
  return new Group().add(
    strokes(sidesOf([set.hull]), PALETTE.grown, WIDTH_PX.line),
    strokes(ends, PALETTE.line, WIDTH_PX.line),
    strokes(sidesOf([set.polygon]), PALETTE.selected, WIDTH_PX.selected),
  );
}

/**
 * Sets of coplanar lines (B99 2): their polygons in colours of their own over the hulls that they were made from; sets that
 * the photographs do not verify are thin and grey.
 */
import { Group } from "three";
import { category, PALETTE } from "../../shared/palette";
import { isVerifiedSet } from "../../shared/proposed";
import type { CoplanarSet, CoplanarSets } from "../../shared/records";
import type { Layer } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";
import { endsOf, sidesOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = { polygon: 3.5, hull: 1.5, refused: 1, line: 2, selected: 5 };
/** Alone, and while something is selected. */
const OPACITY = { polygon: [1, 0.25], hull: [0.8, 0.2], refused: [0.35, 0.0875] } as const;

/** @param lines p0 and p1 of each 3D line, local frame, metres */
export function buildCoplanar({ sets }: CoplanarSets, lines: Float64Array): Layer {
  const numbered = sets.map((set, index) => ({ set, index }));
  const verified = numbered.filter(({ set }) => isVerifiedSet(set));
  const refused = numbered.filter(({ set }) => !isVerifiedSet(set));
  // One entry a side: a click on a side picks its set.
  const sides = (of: typeof numbered) => of.flatMap(({ set, index }) => set.polygon.map(() => index));
  const polygons = (of: typeof numbered) => sidesOf(of.map(({ set }) => set.polygon));
  const hull = strokes(sidesOf(verified.map(({ set }) => set.hull)), PALETTE.grown, WIDTH_PX.hull);
  hull.raycast = () => undefined;
  return partsLayer({
    kind: "coplanar",
    parts: [
      {
        drawn: strokes(polygons(verified), sides(verified).map(category), WIDTH_PX.polygon),
        opacity: OPACITY.polygon,
        things: sides(verified),
      },
      { drawn: hull, opacity: OPACITY.hull },
      {
        drawn: strokes(polygons(refused), PALETTE.unmatched, WIDTH_PX.refused),
        opacity: OPACITY.refused,
        things: sides(refused),
      },
    ],
    chosen: (index) => {
      const set = sets[index];
      return set === undefined ? null : chosenSet(set, lines);
    },
  });
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

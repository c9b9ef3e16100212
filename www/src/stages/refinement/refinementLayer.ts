/**
 * Buildings before refinement, as outlines over the refined facets; gaps that were opened; the sides of relations that were
 * tested (B99 2).
 */
import { Group } from "three";
import { PALETTE } from "../../shared/palette";
import { outlinesBefore } from "../../shared/proposed";
import type { Refinement, Segment3 } from "../../shared/records";
import { pickedIndex, type Selection } from "../../shared/selection";
import type { Layer } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";
import { sidesOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = 1.75;
const SELECTED_PX = 4;
/** Alone, and while something is selected. */
const OPACITY = [1, 0.3] as const;

export function buildRefinement(refinement: Refinement): Layer {
  const rings = refinement.before.facets.flatMap(({ outer, holes }) => [outer, ...holes]);
  const gaps = ends(refinement.gaps.map(({ side }) => side));
  return partsLayer({
    kind: "refinement",
    parts: [
      { drawn: over(sidesOf(rings), PALETTE.grown, WIDTH_PX), opacity: OPACITY },
      { drawn: over(gaps, PALETTE.rejected, WIDTH_PX) },
    ],
    chosen: (_, selection) => shownOf(refinement, selection),
  });
}

/** The old outline of a building with the sides of its relations, or the sides of one of them. */
function shownOf(refinement: Refinement, selection: Selection | null): Group | null {
  if (selection?.kind === "relation") {
    const relation = refinement.buildings[selection.building]?.relations[selection.index];
    return relation === undefined
      ? null
      : new Group().add(over(ends(relation.sides), PALETTE.selected, SELECTED_PX));
  }
  const index = pickedIndex(selection, "refinement");
  const found = refinement.buildings[index];
  if (found === undefined) {
    return null;
  }
  const sides = (adopted: boolean) =>
    ends(found.relations.filter((one) => one.adopted === adopted).flatMap((one) => one.sides));
  return new Group().add(
    over(sidesOf(outlinesBefore(refinement, index)), PALETTE.grown, SELECTED_PX),
    over(sides(false), PALETTE.rejected, SELECTED_PX / 2),
    over(sides(true), PALETTE.border, SELECTED_PX / 2),
  );
}

function ends(sides: readonly Segment3[]): number[] {
  return sides.flatMap(({ p0, p1 }) => [...p0, ...p1]);
}

/** Over the facets, which hide half of what lies in them otherwise. */
function over(positions: number[], colour: string, widthPx: number) {
  const lines = strokes(positions, colour, widthPx);
  lines.material.depthTest = false;
  lines.renderOrder = 3;
  lines.raycast = () => undefined;
  return lines;
}

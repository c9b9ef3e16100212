/** Groups of coplanar half-planes: their lines in the group's colour, and the lines found in their planes (B99 figures 17 to 20). */
import { category, PALETTE } from "../../shared/palette";
import type { FacetTrace } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { zUpGroup } from "../scene/frame";
import { disposeObject, type Layer } from "../scene/layer";
import { SelectedObject } from "../scene/selectedObject";
import { endsOf, strokes } from "../scene/strokes";

const WIDTH_PX = 2.5;
const NEW_LINE_PX = 1.75;
const SELECTED_PX = 5;
const DIMMED = 0.3;

/** @param lines p0 and p1 of each 3D line, local frame, metres */
export function buildGroups(grouping: FacetTrace, lines: Float64Array): Layer {
  const object = zUpGroup();
  // A line of several groups takes the colour of the largest.
  const order = grouping.groups
    .map((group, index) => ({ group, index }))
    .sort((a, b) => b.group.members.length - a.group.members.length);
  const owner = new Map<number, number>();
  for (const { group, index } of order) {
    for (const { line } of group.members) {
      if (!owner.has(line)) {
        owner.set(line, index);
      }
    }
  }
  const members = [...owner];
  const grouped = strokes(
    members.flatMap(([line]) => endsOf(lines, line)),
    members.map(([, group]) => category(group)),
    WIDTH_PX,
  );
  const found = strokes(
    grouping.plane_lines.flatMap(({ segment }) => [...segment.p0, ...segment.p1]),
    PALETTE.bar,
    NEW_LINE_PX,
  );
  object.add(grouped, found);
  const chosen = new SelectedObject(object);

  return {
    object,
    pick: (hit) => {
      const group = hit.object === grouped ? members[hit.faceIndex ?? -1]?.[1] : undefined;
      return group === undefined ? null : { kind: "group", index: group };
    },
    highlight(selection: Selection | null) {
      for (const one of [grouped, found]) {
        one.material.opacity = selection === null ? 1 : DIMMED;
      }
      const group = selection?.kind === "group" ? grouping.groups[selection.index] : undefined;
      const own = [...new Set(group?.members.map(({ line }) => line))];
      const positions = own.flatMap((line) => endsOf(lines, line));
      chosen.show(own.length === 0 ? null : strokes(positions, PALETTE.selected, SELECTED_PX));
    },
    dispose: () => disposeObject(object),
  };
}

/** Groups of coplanar half-planes: their lines in the group's colour, and the lines found in their planes (B99 figures 17 to 20). */
import { Group } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { category, PALETTE } from "../shared/palette";
import { LINE_STRIDE } from "../shared/results";
import type { Selection } from "../shared/selection";
import type { Grouping } from "../shared/traces";
import { zUpGroup } from "./frame";
import { disposeObject, type Layer, rgb } from "./layer";

const WIDTH_PX = 2.5;
const NEW_LINE_PX = 1.75;
const SELECTED_PX = 5;
const DIMMED = 0.3;

/** @param lines p0 and p1 of each 3D line, local frame, metres */
export function buildGroups(grouping: Grouping, lines: Float64Array): Layer {
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
    members.flatMap(([line]) => [...lines.subarray(line * LINE_STRIDE, (line + 1) * LINE_STRIDE)]),
    members.map(([, group]) => category(group)),
    WIDTH_PX,
  );
  const found = strokes(
    grouping.plane_lines.flatMap(({ segment }) => [...segment.p0, ...segment.p1]),
    grouping.plane_lines.map(() => PALETTE.bar),
    NEW_LINE_PX,
  );
  object.add(grouped, found);
  let chosen: Group | null = null;

  return {
    object,
    pick: (hit) => {
      const group = hit.object === grouped ? members[hit.faceIndex ?? -1]?.[1] : undefined;
      return group === undefined ? null : { kind: "group", index: group };
    },
    highlight(selection: Selection | null) {
      if (chosen !== null) {
        object.remove(chosen);
        disposeObject(chosen);
        chosen = null;
      }
      for (const one of [grouped, found]) {
        one.material.opacity = selection === null ? 1 : DIMMED;
      }
      const group = selection?.kind === "group" ? grouping.groups[selection.index] : undefined;
      if (group !== undefined) {
        const own = [...new Set(group.members.map(({ line }) => line))];
        const positions = own.flatMap((line) => [
          ...lines.subarray(line * LINE_STRIDE, (line + 1) * LINE_STRIDE),
        ]);
        const marked = strokes(
          positions,
          own.map(() => PALETTE.selected),
          SELECTED_PX,
        );
        marked.raycast = () => undefined;
        chosen = new Group().add(marked);
        object.add(chosen);
      }
    },
    dispose: () => disposeObject(object),
  };
}

/** Lines of constant width on the screen, one colour each. */
export function strokes(positions: number[], colours: readonly string[], widthPx: number): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(positions);
  geometry.setColors(
    colours.flatMap((colour) => {
      const one = rgb(colour);
      return [...one, ...one];
    }),
  );
  const material = new LineMaterial({ vertexColors: true, linewidth: widthPx, transparent: true });
  return new LineSegments2(geometry, material);
}

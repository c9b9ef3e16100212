/** 3D lines as lines of constant width on the screen. */
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { PALETTE } from "../shared/palette";
import { LINE_STRIDE } from "../shared/results";
import type { Selection } from "../shared/selection";
import { zUpGroup } from "./frame";
import { disposeObject, type Layer } from "./layer";

const WIDTH_PX = 2.25;
const SELECTED_WIDTH_PX = 5;
const DIMMED = 0.35;

/**
 * @param lines p0 and p1 of each line, local frame, metres
 * @param linesOf the lines that belong to a selection
 */
export function buildLines(
  lines: Float64Array,
  linesOf: (selection: Selection | null) => readonly number[] = lineOf,
): Layer {
  const object = zUpGroup();
  const all = segments(Float32Array.from(lines), PALETTE.line, WIDTH_PX);
  object.add(all);
  let chosen: LineSegments2 | null = null;

  return {
    object,
    pick: (hit) => ({ kind: "line", index: hit.faceIndex ?? 0 }),
    highlight(selection: Selection | null) {
      if (chosen !== null) {
        object.remove(chosen);
        disposeObject(chosen);
        chosen = null;
      }
      all.material.opacity = selection === null ? 1 : DIMMED;
      const own = linesOf(selection).filter((index) => (index + 1) * LINE_STRIDE <= lines.length);
      if (own.length > 0) {
        const ends = own.flatMap((index) => [
          ...lines.subarray(index * LINE_STRIDE, (index + 1) * LINE_STRIDE),
        ]);
        chosen = segments(Float32Array.from(ends), PALETTE.selected, SELECTED_WIDTH_PX);
        chosen.material.depthTest = false;
        chosen.renderOrder = 2;
        chosen.raycast = () => undefined;
        object.add(chosen);
      }
    },
    dispose: () => disposeObject(object),
  };
}

function segments(positions: Float32Array, colour: string, linewidth: number): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(positions);
  return new LineSegments2(geometry, new LineMaterial({ color: colour, linewidth, transparent: true }));
}

function lineOf(selection: Selection | null): readonly number[] {
  return selection?.kind === "line" ? [selection.index] : [];
}

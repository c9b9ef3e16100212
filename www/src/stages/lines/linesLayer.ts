/** 3D lines, matched and new, as lines of constant width on the screen. */
import type { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LINE_STRIDE } from "../../shared/flatArrays";
import { PALETTE } from "../../shared/palette";
import type { LineOrigin, LineRecord } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { opacityOf } from "../../viewer/scene/certainty";
import type { Layer } from "../../viewer/scene/layer";
import { type Part, partsLayer } from "../../viewer/scene/partsLayer";
import { endsOf, strokes } from "../../viewer/scene/strokes";

const WIDTH_PX = 2.25;
const SELECTED_WIDTH_PX = 5;
const DIMMED = 0.35;
/** Of lines that no view shows, metres. */
const DASH_M = 0.4;

/** As the border lines in plan. */
export const ORIGIN_COLOURS: Record<LineOrigin, string> = {
  matched: PALETTE.line,
  clustered: PALETTE.grown,
  intersection: PALETTE.merged,
  border: PALETTE.border,
};

/** A line without support in any view: it is where two planes intersect, and drawn dashed. */
export function isUnseen({ origin, supports }: Pick<LineRecord, "origin" | "supports">): boolean {
  return origin !== "matched" && supports.length === 0;
}

/** By how a line was found, and as what is rejected where the model contradicts it. */
export function colourOf(record: Pick<LineRecord, "origin" | "contradiction"> | undefined): string {
  return record?.contradiction == null ? ORIGIN_COLOURS[record?.origin ?? "matched"] : PALETTE.rejected;
}

/** A line is as opaque as it is probable; what the model contradicts has its colour to say so. */
export function opacityOfLine(record: Pick<LineRecord, "probability" | "contradiction"> | undefined): number {
  return record?.contradiction == null ? opacityOf(record?.probability) : 1;
}

/**
 * @param lines p0 and p1 of each line, local frame, metres
 * @param linesOf the lines that belong to a selection
 */
export function buildLines(
  lines: Float64Array,
  records: readonly LineRecord[],
  linesOf: (selection: Selection | null) => readonly number[],
): Layer {
  const count = Math.floor(lines.length / LINE_STRIDE);
  const indices = Array.from({ length: count }, (_, i) => i);
  const unseen = (index: number) => records[index] !== undefined && isUnseen(records[index]);
  const opacity = (index: number) => opacityOfLine(records[index]);
  const colour = (index: number) => colourOf(records[index]);
  const draw = (own: readonly number[]) => {
    const drawn = strokes(
      own.flatMap((i) => endsOf(lines, i)),
      own.map(colour),
      WIDTH_PX,
    );
    return unseen(own[0] as number) ? dashed(drawn) : drawn;
  };
  // Solid before dashed, opaque before faint: each look has a material of its own.
  const opacities = [...new Set(indices.map(opacity))].sort((a, b) => b - a);
  const parts = [indices.filter((i) => !unseen(i)), indices.filter(unseen)]
    .flatMap((alike) => opacities.map((one) => alike.filter((i) => opacity(i) === one)))
    .filter((own) => own.length > 0)
    .map((own): Part => {
      const alone = opacity(own[0] as number);
      return { drawn: draw(own), opacity: [alone, DIMMED * alone], things: own };
    });
  return partsLayer({
    kind: "line",
    parts,
    chosen: (_, selection) => {
      const own = linesOf(selection).filter((index) => index < count);
      return own.length === 0 ? null : above(own.flatMap((index) => endsOf(lines, index)));
    },
  });
}

function dashed(drawn: LineSegments2): LineSegments2 {
  drawn.computeLineDistances();
  drawn.material.dashed = true;
  drawn.material.dashSize = DASH_M;
  drawn.material.gapSize = DASH_M / 2;
  return drawn;
}

/** Selected lines, over whatever lies before them. */
function above(positions: number[]): LineSegments2 {
  const drawn = strokes(positions, PALETTE.selected, SELECTED_WIDTH_PX);
  drawn.material.depthTest = false;
  drawn.renderOrder = 2;
  return drawn;
}

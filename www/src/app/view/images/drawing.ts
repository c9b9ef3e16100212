/** Draws one view's image and overlay. It computes nothing but where things lie on the screen. */
import type { Mark } from "../../../kinds/parts/marks";
import { REJECTED_STRIDE, SEGMENT_STRIDE, SUPPORT_KINDS, SUPPORT_STRIDE } from "../../../shared/flatArrays";
import { rectangle } from "../../../shared/linear";
import { category, PALETTE } from "../../../shared/palette";
import type { Vec2 } from "../../../shared/records";
import type { Selection } from "../../../shared/selection";
import { textScale } from "../../state/textScale";
import type { GraphOverlay } from "./graphOverlay";
import type { Pen, PenPath, Window } from "./pen";

export interface Overlay {
  /** x0, y0, x1, y1 per segment. */
  segments: Float32Array | null;
  /** x0, y0, x1, y1, kind, line per support. */
  supports: Float32Array | null;
  /** x0, y0, x1, y1, reason per rejected line of edgels. */
  rejected?: Float32Array | null;
  /** Regions: their rings, each with its colour. */
  regions?: readonly { rings: readonly (readonly Vec2[])[]; colour: string }[] | null;
  /** What a click finds first where both lie: lines, unless this is set. */
  segmentsFirst?: boolean;
  /** An adjacency graph: its corners, edges and regions. */
  graph?: GraphOverlay | null;
  /** A colour for each segment; the palette's where there is none. */
  colours?: readonly (string | null)[] | null;
}

const LINE_PX = 1.75;
const THIN_PX = 1;
const SELECTED_PX = 4;
const DIMMED = 0.35;

export function drawView(
  pen: Pen,
  window: Window,
  image: ImageBitmap,
  overlay: Overlay,
  selection: Selection | null,
  marks: readonly Mark[],
): void {
  pen.image(image);
  const unit = textScale.peek() / window.viewport.scale;
  const { segments, supports, rejected, regions, colours } = overlay;
  const dimmed = selection === null ? 1 : DIMMED;
  const strokes = (
    data: Float32Array,
    stride: number,
    isWanted: (at: number) => boolean,
    colour: string,
    width: number,
    alpha: number,
  ) => strokeAll(pen, data, stride, isWanted, { colour, width: width * unit, alpha: alpha * dimmed });
  const all = () => true;
  if (regions != null) {
    fillRegions(pen, regions, unit, dimmed);
  }
  if (rejected != null) {
    strokes(rejected, REJECTED_STRIDE, all, PALETTE.rejected, THIN_PX, 0.9);
  }
  if (segments !== null && colours != null) {
    const ofColour = (colour: string | null) => (at: number) => colours[at / SEGMENT_STRIDE] === colour;
    strokes(segments, SEGMENT_STRIDE, ofColour(null), PALETTE.unmatched, THIN_PX, 0.7);
    const isColoured = (at: number) => colours[at / SEGMENT_STRIDE] !== null;
    strokes(segments, SEGMENT_STRIDE, isColoured, PALETTE.casing, LINE_PX + 1.5, 0.6);
    for (const colour of new Set(colours)) {
      if (colour !== null) {
        strokes(segments, SEGMENT_STRIDE, ofColour(colour), colour, LINE_PX, 1);
      }
    }
  } else if (segments !== null) {
    const isAlone = supports === null;
    strokes(segments, SEGMENT_STRIDE, all, PALETTE.casing, LINE_PX + 1.5, 0.35);
    strokes(
      segments,
      SEGMENT_STRIDE,
      all,
      PALETTE.unmatched,
      isAlone ? LINE_PX : THIN_PX,
      isAlone ? 1 : 0.75,
    );
  }
  if (supports !== null) {
    strokes(supports, SUPPORT_STRIDE, all, PALETTE.casing, LINE_PX + 1.75, 0.5);
    SUPPORT_KINDS.forEach((kind, code) => {
      const isKind = (at: number) => supports[at + 4] === code;
      strokes(supports, SUPPORT_STRIDE, isKind, PALETTE[kind], LINE_PX, 1);
    });
  }
  if (overlay.graph != null) {
    drawGraph(pen, overlay.graph, unit, dimmed);
  }
  for (const mark of marks) {
    drawMark(pen, window, mark, unit);
  }
  if (selection?.kind === "line" && supports !== null) {
    const isChosen = (at: number) => supports[at + 5] === selection.index;
    const chosen = (colour: string, width: number, alpha: number) =>
      strokeAll(pen, supports, SUPPORT_STRIDE, isChosen, { colour, width: width * unit, alpha });
    chosen(PALETTE.casing, SELECTED_PX + 2.5, 0.9);
    chosen(PALETTE.selected, SELECTED_PX, 1);
  }
}

/** A polyline with a dark casing, so that it stands on any photograph. */
function drawMark(pen: Pen, window: Window, mark: Mark, unit: number): void {
  if (mark.points.length === 0) {
    return;
  }
  const path = pen.path();
  trace(path, mark.points);
  if (mark.closed) {
    path.closePath();
  }
  const { colour, width } = mark;
  if (mark.fill !== undefined) {
    pen.fill(path, { colour, alpha: mark.fill });
  }
  pen.stroke(path, { colour: PALETTE.casing, width: (width + 2) * unit, alpha: 0.75, join: "round" });
  const dash = mark.dashed ? [7 * unit, 5 * unit] : [];
  pen.stroke(path, { colour, width: width * unit, alpha: 1, dash, join: "round" });
  if (mark.label !== undefined) {
    drawLabel(pen, window, mark.label, mark, unit);
  }
}

function trace(path: PenPath, points: readonly Vec2[]): void {
  for (const [i, [x, y]] of points.entries()) {
    if (i === 0) {
      path.moveTo(x, y);
    } else {
      path.lineTo(x, y);
    }
  }
}

/** Beside the right end of what is seen of the mark, or the left one: there it hides none of it. */
function drawLabel(
  pen: Pen,
  window: Window,
  text: string,
  { points, colour, labelSide = "right" }: Mark,
  unit: number,
): void {
  const size = 11.5 * unit;
  const width = pen.widthOf(text, size) + 8 * unit;
  const isLeft = labelSide === "left";
  const [x, y] = labelPlace(window, points, isLeft, width + 8 * unit, 19 * unit);
  const left = isLeft ? x - width - 4 * unit : x + 4 * unit;
  const top = labelSide === "below" ? y + 2 * unit : y - 17 * unit;
  const plate = pen.path();
  trace(plate, rectangle([left, top], [left + width, top + 15 * unit]));
  pen.fill(plate, { colour: PALETTE.casing, alpha: 0.85 });
  pen.text(text, left + 4 * unit, top + size, size, colour);
}

/** In so many steps a side of a mark is gone along, to find a place for its label. */
const LABEL_STEPS = 48;

/** The outermost place of a polyline that leaves room for a label in the picture; the middle where none does. */
function labelPlace(
  { viewport: { scale, x: dx, y: dy }, box }: Window,
  points: readonly Vec2[],
  isLeft: boolean,
  width: number,
  height: number,
): Vec2 {
  const [x0, x1] = [-dx / scale + (isLeft ? width : 0), (box.width - dx) / scale - (isLeft ? 0 : width)];
  const [y0, y1] = [-dy / scale + height, (box.height - dy) / scale - height];
  const places = points.flatMap(([px, py], i): Vec2[] => {
    const [qx, qy] = points[i + 1] ?? [px, py];
    return Array.from({ length: LABEL_STEPS + 1 }, (_, k) => {
      const t = k / LABEL_STEPS;
      return [px + t * (qx - px), py + t * (qy - py)];
    });
  });
  const seen = places.filter(([x, y]) => x >= x0 && x <= x1 && y >= y0 && y <= y1);
  const outermost = seen.sort(([p], [q]) => (isLeft ? p - q : q - p))[0];
  return outermost ?? places[Math.floor(places.length / 2)] ?? [0, 0];
}

function fillRegions(
  pen: Pen,
  regions: readonly { rings: readonly (readonly Vec2[])[]; colour: string }[],
  unit: number,
  alpha: number,
): void {
  const outlines = pen.path();
  for (const { rings, colour } of regions) {
    const path = pen.path();
    for (const ring of rings) {
      for (const one of [path, outlines]) {
        trace(one, ring);
        one.closePath();
      }
    }
    pen.fill(path, { colour, alpha: 0.6 * alpha, rule: "evenodd" });
  }
  pen.stroke(outlines, { colour: PALETTE.beam, width: 0.75 * unit, alpha });
}

/** Sectors in the colours of their regions, edges and corners in those of what was found in other views. */
function drawGraph(pen: Pen, { sectors, edges, corners }: GraphOverlay, unit: number, alpha: number): void {
  for (const { ring, region } of sectors) {
    const path = pen.path();
    trace(path, ring);
    path.closePath();
    pen.fill(path, { colour: category(region), alpha: 0.55 * alpha });
  }
  for (const isMatched of [false, true]) {
    const path = pen.path();
    for (const { ends } of edges.filter((edge) => edge.isMatched === isMatched)) {
      trace(path, ends);
    }
    const colour = isMatched ? PALETTE.matched : PALETTE.unmatched;
    pen.stroke(path, { colour, width: (isMatched ? LINE_PX : THIN_PX) * unit, alpha });
  }
  for (const { at, space } of corners) {
    const dot = pen.path();
    dot.circle(at[0], at[1], (space === null ? 2 : 3.5) * unit);
    pen.fill(dot, { colour: space === null ? PALETTE.unmatched : PALETTE.matched, alpha });
  }
}

function strokeAll(
  pen: Pen,
  data: Float32Array,
  stride: number,
  isWanted: (at: number) => boolean,
  style: { colour: string; width: number; alpha: number },
): void {
  const path = pen.path();
  for (let at = 0; at + stride <= data.length; at += stride) {
    if (isWanted(at)) {
      path.moveTo(data[at] as number, data[at + 1] as number);
      path.lineTo(data[at + 2] as number, data[at + 3] as number);
    }
  }
  pen.stroke(path, style);
}

/** Draws one view's image and overlay on a canvas. It computes nothing but where things lie on the screen. */

import { REJECTED_STRIDE, SEGMENT_STRIDE, SUPPORT_KINDS, SUPPORT_STRIDE } from "../../shared/flatArrays";
import { category, PALETTE } from "../../shared/palette";
import type { Vec2 } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { textScale } from "../state/textScale";
import type { GraphOverlay } from "./graphOverlay";
import type { Mark } from "./selectionMarks";
import type { Viewport } from "./viewport";

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
/** From this zoom on, single pixels are what a viewer wants to see. */
const PIXELATED_FROM = 4;

export function drawView(
  context: CanvasRenderingContext2D,
  image: ImageBitmap,
  viewport: Viewport,
  pixelRatio: number,
  overlay: Overlay,
  selection: Selection | null,
  marks: readonly Mark[],
): void {
  const { canvas } = context;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  const scale = viewport.scale * pixelRatio;
  context.setTransform(scale, 0, 0, scale, viewport.x * pixelRatio, viewport.y * pixelRatio);
  context.imageSmoothingEnabled = viewport.scale < PIXELATED_FROM;
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0);
  context.lineCap = "round";
  const unit = textScale.peek() / viewport.scale;
  const { segments, supports, rejected, regions, colours } = overlay;
  context.globalAlpha = selection === null ? 1 : DIMMED;
  if (regions != null) {
    fillRegions(context, regions, unit);
  }
  if (rejected != null) {
    strokeAll(context, rejected, REJECTED_STRIDE, () => true, PALETTE.rejected, THIN_PX * unit, 0.9);
  }
  if (segments !== null && colours != null) {
    const ofColour = (colour: string | null) => (at: number) => colours[at / SEGMENT_STRIDE] === colour;
    strokeAll(context, segments, SEGMENT_STRIDE, ofColour(null), PALETTE.unmatched, THIN_PX * unit, 0.7);
    const isColoured = (at: number) => colours[at / SEGMENT_STRIDE] !== null;
    strokeAll(context, segments, SEGMENT_STRIDE, isColoured, PALETTE.casing, (LINE_PX + 1.5) * unit, 0.6);
    for (const colour of new Set(colours)) {
      if (colour !== null) {
        strokeAll(context, segments, SEGMENT_STRIDE, ofColour(colour), colour, LINE_PX * unit, 1);
      }
    }
  } else if (segments !== null) {
    const isAlone = supports === null;
    strokeAll(context, segments, SEGMENT_STRIDE, () => true, PALETTE.casing, (LINE_PX + 1.5) * unit, 0.35);
    const width = (isAlone ? LINE_PX : THIN_PX) * unit;
    strokeAll(context, segments, SEGMENT_STRIDE, () => true, PALETTE.unmatched, width, isAlone ? 1 : 0.75);
  }
  if (supports !== null) {
    strokeAll(context, supports, SUPPORT_STRIDE, () => true, PALETTE.casing, (LINE_PX + 1.75) * unit, 0.5);
    SUPPORT_KINDS.forEach((kind, code) => {
      const isKind = (at: number) => supports[at + 4] === code;
      strokeAll(context, supports, SUPPORT_STRIDE, isKind, PALETTE[kind], LINE_PX * unit, 1);
    });
  }
  if (overlay.graph != null) {
    drawGraph(context, overlay.graph, unit);
  }
  context.globalAlpha = 1;
  for (const mark of marks) {
    drawMark(context, mark, unit);
  }
  if (selection?.kind === "line" && supports !== null) {
    const isChosen = (at: number) => supports[at + 5] === selection.index;
    strokeAll(context, supports, SUPPORT_STRIDE, isChosen, PALETTE.casing, (SELECTED_PX + 2.5) * unit, 0.9);
    strokeAll(context, supports, SUPPORT_STRIDE, isChosen, PALETTE.selected, SELECTED_PX * unit, 1);
  }
}

/** A polyline with a dark casing, so that it stands on any photograph. */
function drawMark(context: CanvasRenderingContext2D, mark: Mark, unit: number): void {
  const [first] = mark.points;
  if (first === undefined) {
    return;
  }
  const path = new Path2D();
  trace(path, mark.points);
  if (mark.closed) {
    path.closePath();
  }
  context.lineJoin = "round";
  if (mark.fill !== undefined) {
    context.globalAlpha = mark.fill;
    context.fillStyle = mark.colour;
    context.fill(path);
  }
  context.globalAlpha = 0.75;
  context.strokeStyle = PALETTE.casing;
  context.lineWidth = (mark.width + 2) * unit;
  context.setLineDash([]);
  context.stroke(path);
  context.globalAlpha = 1;
  context.strokeStyle = mark.colour;
  context.lineWidth = mark.width * unit;
  context.setLineDash(mark.dashed ? [7 * unit, 5 * unit] : []);
  context.stroke(path);
  context.setLineDash([]);
  if (mark.label !== undefined) {
    drawLabel(context, mark.label, mark, unit);
  }
}

function trace(path: Path2D, points: readonly Vec2[]): void {
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
  context: CanvasRenderingContext2D,
  text: string,
  { points, colour, labelSide = "right" }: Mark,
  unit: number,
): void {
  context.font = `600 ${11.5 * unit}px system-ui, "Liberation Sans", sans-serif`;
  const width = context.measureText(text).width + 8 * unit;
  const isLeft = labelSide === "left";
  const [x, y] = labelPlace(context, points, isLeft, width + 8 * unit, 19 * unit);
  const left = isLeft ? x - width - 4 * unit : x + 4 * unit;
  const top = labelSide === "below" ? y + 2 * unit : y - 17 * unit;
  context.globalAlpha = 0.85;
  context.fillStyle = PALETTE.casing;
  context.fillRect(left, top, width, 15 * unit);
  context.globalAlpha = 1;
  context.fillStyle = colour;
  context.fillText(text, left + 4 * unit, top + 11.5 * unit);
}

/** In so many steps a side of a mark is gone along, to find a place for its label. */
const LABEL_STEPS = 48;

/** The outermost place of a polyline that leaves room for a label in the picture; the middle where none does. */
function labelPlace(
  context: CanvasRenderingContext2D,
  points: readonly Vec2[],
  isLeft: boolean,
  width: number,
  height: number,
): Vec2 {
  const { a, d, e, f } = context.getTransform();
  const [x0, x1] = [-e / a + (isLeft ? width : 0), (context.canvas.width - e) / a - (isLeft ? 0 : width)];
  const [y0, y1] = [-f / d + height, (context.canvas.height - f) / d - height];
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
  context: CanvasRenderingContext2D,
  regions: readonly { rings: readonly (readonly Vec2[])[]; colour: string }[],
  unit: number,
): void {
  const before = context.globalAlpha;
  const outlines = new Path2D();
  for (const { rings, colour } of regions) {
    const path = new Path2D();
    for (const ring of rings) {
      trace(path, ring);
      path.closePath();
    }
    context.globalAlpha = before * 0.6;
    context.fillStyle = colour;
    context.fill(path, "evenodd");
    outlines.addPath(path);
  }
  context.globalAlpha = before;
  context.strokeStyle = PALETTE.beam;
  context.lineWidth = 0.75 * unit;
  context.stroke(outlines);
}

/** Sectors in the colours of their regions, edges and corners in those of what was found in other views. */
function drawGraph(
  context: CanvasRenderingContext2D,
  { sectors, edges, corners }: GraphOverlay,
  unit: number,
): void {
  const before = context.globalAlpha;
  for (const { ring, region } of sectors) {
    const path = new Path2D();
    trace(path, ring);
    path.closePath();
    context.globalAlpha = before * 0.55;
    context.fillStyle = category(region);
    context.fill(path);
  }
  context.globalAlpha = before;
  for (const isMatched of [false, true]) {
    const path = new Path2D();
    for (const { ends } of edges.filter((edge) => edge.isMatched === isMatched)) {
      trace(path, ends);
    }
    context.strokeStyle = isMatched ? PALETTE.matched : PALETTE.unmatched;
    context.lineWidth = (isMatched ? LINE_PX : THIN_PX) * unit;
    context.stroke(path);
  }
  for (const { at, space } of corners) {
    context.beginPath();
    context.arc(at[0], at[1], (space === null ? 2 : 3.5) * unit, 0, 2 * Math.PI);
    context.fillStyle = space === null ? PALETTE.unmatched : PALETTE.matched;
    context.fill();
  }
}

function strokeAll(
  context: CanvasRenderingContext2D,
  data: Float32Array,
  stride: number,
  isWanted: (at: number) => boolean,
  colour: string,
  width: number,
  alpha: number,
): void {
  const path = new Path2D();
  for (let at = 0; at + stride <= data.length; at += stride) {
    if (isWanted(at)) {
      path.moveTo(data[at] as number, data[at + 1] as number);
      path.lineTo(data[at + 2] as number, data[at + 3] as number);
    }
  }
  const before = context.globalAlpha;
  context.globalAlpha = before * alpha;
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke(path);
  context.globalAlpha = before;
}

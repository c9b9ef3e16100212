/** Draws one view's image and overlay on a canvas. It computes nothing but where things lie on the screen. */
import { PALETTE } from "../shared/palette";
import { SEGMENT_STRIDE, SUPPORT_KINDS, SUPPORT_STRIDE } from "../shared/results";
import type { Selection } from "../shared/selection";
import type { Viewport } from "./overlay";

export interface Overlay {
  /** x0, y0, x1, y1 per segment. */
  segments: Float32Array | null;
  /** x0, y0, x1, y1, kind, line per support. */
  supports: Float32Array | null;
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
  view: number,
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
  const unit = 1 / viewport.scale;
  const { segments, supports } = overlay;
  context.globalAlpha = selection === null ? 1 : DIMMED;
  if (segments !== null) {
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
  context.globalAlpha = 1;
  drawSelection(context, overlay, selection, view, unit);
}

function drawSelection(
  context: CanvasRenderingContext2D,
  { segments, supports }: Overlay,
  selection: Selection | null,
  view: number,
  unit: number,
): void {
  const strokeChosen = (data: Float32Array, stride: number, isChosen: (at: number) => boolean) => {
    strokeAll(context, data, stride, isChosen, PALETTE.casing, (SELECTED_PX + 2.5) * unit, 0.9);
    strokeAll(context, data, stride, isChosen, PALETTE.selected, SELECTED_PX * unit, 1);
  };
  if (selection?.kind === "segment" && selection.view === view && segments !== null) {
    strokeChosen(segments, SEGMENT_STRIDE, (at) => at === selection.index * SEGMENT_STRIDE);
  }
  if (selection?.kind === "line" && supports !== null) {
    strokeChosen(supports, SUPPORT_STRIDE, (at) => supports[at + 5] === selection.index);
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

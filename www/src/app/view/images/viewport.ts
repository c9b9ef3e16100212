/**
 * Geometry of a zoomed image: where image pixels lie on the canvas, and which segment is under the pointer.
 * The centre of the top-left pixel is (0.5, 0.5), as in the core, so image coordinates need no shift.
 */
import { boundsOf } from "../../../shared/linear";

export interface Point {
  x: number;
  y: number;
}

/** canvas = image * scale + (x, y), in CSS pixels. */
export interface Viewport {
  scale: number;
  x: number;
  y: number;
}

export interface Size {
  width: number;
  height: number;
}

const MAX_SCALE = 64;

/** The whole image, centred, with a small margin. */
export function fitImage(image: Size, box: Size, marginPx = 8): Viewport {
  const width = Math.max(1, box.width - 2 * marginPx);
  const height = Math.max(1, box.height - 2 * marginPx);
  const scale = Math.min(width / image.width, height / image.height);
  return {
    scale,
    x: (box.width - image.width * scale) / 2,
    y: (box.height - image.height * scale) / 2,
  };
}

/** The viewport that shows some image points with a margin, no closer than `maxScale`; null where there are none. */
export function fitPoints(
  points: readonly (readonly [number, number])[],
  box: Size,
  marginPx: number,
  maxScale: number,
): Viewport | null {
  if (points.length === 0) {
    return null;
  }
  const [x0, y0, x1, y1] = boundsOf(points);
  const scale = Math.min(
    maxScale,
    box.width / (x1 - x0 + 2 * marginPx),
    box.height / (y1 - y0 + 2 * marginPx),
  );
  return { scale, x: box.width / 2 - (scale * (x0 + x1)) / 2, y: box.height / 2 - (scale * (y0 + y1)) / 2 };
}

/** Zooms by `factor` so that the image point under `at` (CSS pixels) stays there. */
export function zoomAt(viewport: Viewport, at: Point, factor: number, minScale: number): Viewport {
  const scale = Math.min(MAX_SCALE, Math.max(minScale, viewport.scale * factor));
  const ratio = scale / viewport.scale;
  return { scale, x: at.x - (at.x - viewport.x) * ratio, y: at.y - (at.y - viewport.y) * ratio };
}

export function pan(viewport: Viewport, dx: number, dy: number): Viewport {
  return { ...viewport, x: viewport.x + dx, y: viewport.y + dy };
}

/** Two fingers move: the image points below them stay there, as far as scale and shift can do that. */
export function pinch(
  viewport: Viewport,
  [a, b]: readonly [Point, Point],
  [nextA, nextB]: readonly [Point, Point],
  minScale: number,
): Viewport {
  const apart = (p: Point, q: Point) => Math.max(1, Math.hypot(p.x - q.x, p.y - q.y));
  const middle = (p: Point, q: Point) => ({ x: (p.x + q.x) / 2, y: (p.y + q.y) / 2 });
  const [from, to] = [middle(a, b), middle(nextA, nextB)];
  const zoomed = zoomAt(viewport, from, apart(nextA, nextB) / apart(a, b), minScale);
  return pan(zoomed, to.x - from.x, to.y - from.y);
}

/** The image position of a point of the canvas. */
export function toImage(viewport: Viewport, at: Point): Point {
  return { x: (at.x - viewport.x) / viewport.scale, y: (at.y - viewport.y) / viewport.scale };
}

/** Index of the segment (first four numbers of each entry) nearest to a point within `reach`, or -1. */
export function nearestSegment(data: Float32Array, stride: number, at: Point, reach: number): number {
  let best = -1;
  let bestDistance = reach;
  for (let i = 0; i + stride <= data.length; i += stride) {
    const distance = distanceToSegment(at, data, i);
    if (distance < bestDistance) {
      bestDistance = distance;
      best = i / stride;
    }
  }
  return best;
}

function distanceToSegment(at: Point, data: Float32Array, offset: number): number {
  const [x0, y0, x1, y1] = data.subarray(offset, offset + 4) as unknown as [number, number, number, number];
  const dx = x1 - x0;
  const dy = y1 - y0;
  const lengthSquared = dx * dx + dy * dy;
  const along = lengthSquared > 0 ? ((at.x - x0) * dx + (at.y - y0) * dy) / lengthSquared : 0;
  const t = Math.min(1, Math.max(0, along));
  return Math.hypot(at.x - x0 - t * dx, at.y - y0 - t * dy);
}

/** The plan of a flight as a drawing: north up, metres of the world to its units. */
import type { Region } from "../tiles/flight";

/** Width of the drawing, in its own units. */
export const WIDTH = 1000;

export interface PlanFrame {
  width: number;
  height: number;
  toDrawing(place: readonly [x: number, y: number]): [number, number];
  /** @param u, v fractions of the width from the left and of the height from the top */
  toWorld(u: number, v: number): [number, number];
  /** Units of the drawing for a length in metres. */
  scale: number;
}

export function frameOf([x0, y0, x1, y1]: Region): PlanFrame {
  const scale = WIDTH / Math.max(x1 - x0, Number.MIN_VALUE);
  const height = (y1 - y0) * scale;
  return {
    width: WIDTH,
    height,
    scale,
    toDrawing: ([x, y]) => [(x - x0) * scale, height - (y - y0) * scale],
    toWorld: (u, v) => [x0 + u * (x1 - x0), y1 - v * (y1 - y0)],
  };
}

export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

export function boxOf(frame: PlanFrame, [x0, y0, x1, y1]: Region): Box {
  const [left, bottom] = frame.toDrawing([x0, y0]);
  const [right, top] = frame.toDrawing([x1, y1]);
  return { x: left, y: top, width: right - left, height: bottom - top };
}

/** The region between two places, in whole metres, inside the frame's own corners. */
export function regionBetween(
  [ax, ay]: readonly [number, number],
  [bx, by]: readonly [number, number],
): [number, number, number, number] {
  return [
    Math.round(Math.min(ax, bx)),
    Math.round(Math.min(ay, by)),
    Math.round(Math.max(ax, bx)),
    Math.round(Math.max(ay, by)),
  ];
}

/** How well a place is covered, by the number of photographs that show it. */
interface Cover {
  from: number;
  words: string;
  alpha: number;
}

export const COVERS: readonly Cover[] = [
  { from: 1, words: "1 or 2: too few", alpha: 0.1 },
  { from: 3, words: "3 to 5", alpha: 0.3 },
  { from: 6, words: "6 to 11", alpha: 0.5 },
  { from: 12, words: "12 or more", alpha: 0.75 },
];

export function coverOf(count: number): Cover | null {
  return COVERS.findLast(({ from }) => count >= from) ?? null;
}

/** The middle distance from a place to the nearest other one; the whole where there is one place. */
export function spacingOf(places: readonly (readonly [number, number])[], whole: number): number {
  const nearest = places.map(([x, y], i) =>
    places.reduce(
      (least, [u, v], j) => (i === j ? least : Math.min(least, Math.hypot(x - u, y - v))),
      Number.POSITIVE_INFINITY,
    ),
  );
  const sorted = nearest.filter(Number.isFinite).sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)] ?? whole;
}

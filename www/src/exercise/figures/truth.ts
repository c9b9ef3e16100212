/**
 * What is true of the demo scene: the roofs from which its photographs were rendered (`demoTruth.json`, by scripts/demoTruth.mjs), and
 * which of them an image line, a 3D line or a facet shows. Metres, in the scene's local frame; pixels.
 */
import { lineAt, segmentAt } from "../../shared/flatArrays";
import {
  add,
  cross,
  DEGREE,
  distance2,
  dot,
  isInside,
  mix3,
  nearestOf,
  scaled,
  thetaFrame,
} from "../../shared/linear";
import type { Side, ViewInfo } from "../../shared/records";
import type { Figure } from "../../stages/figure";
import demo from "./demoTruth.json";

export type Point = readonly [x: number, y: number, z: number];
export type Place = readonly [x: number, y: number];
export type Stretch = readonly [Place, Place];

export interface RoofEdge {
  kind: string;
  p0: Point;
  p1: Point;
  /** The faces beside it, by their ids. */
  faces: readonly string[];
}

export interface RoofFace {
  id: string;
  building: string;
  /** Unit normal, which points up, and d: n · X + d = 0. */
  plane: readonly [number, number, number, number];
  polygon: readonly Point[];
  slope_deg: number;
}

export const FACES = demo.faces as unknown as readonly RoofFace[];
export const EDGES = demo.edges as unknown as readonly RoofEdge[];

/** So near an image line is to the edge that it shows, pixels, and so parallel. */
const NEAR_PX = 1.6;
const PARALLEL = Math.cos(4 * DEGREE);
/** So near a 3D line is to an edge, metres. */
const NEAR_M = 0.3;

/** Whether a scene is the demo scene, of which all this is true. */
export function isDemo({ scene }: Pick<Figure, "scene">): boolean {
  return scene !== null && demo.origin.every((value, i) => Math.abs(value - (scene.origin[i] ?? 0)) < 1);
}

/** Where a view shows a point. */
export function imageIn(view: ViewInfo, [x, y, z]: Point): Place {
  const [a, b, w] = [0, 4, 8].map((row) => {
    const [p = 0, q = 0, r = 0, s = 0] = view.projection.slice(row, row + 4);
    return p * x + q * y + r * z + s;
  }) as [number, number, number];
  return [a / w, b / w];
}

/** A segment that a view was found to have. */
export function segmentOf({ results }: Figure, view: number, index: number): Stretch | null {
  return segmentAt(results.segments[view], index);
}

/** How a stretch lies to a line: the largest distance of its ends, and how much of it lies beside the line. */
function apart([p, q]: Stretch, [a, b]: Stretch): { distance: number; isParallel: boolean; share: number } {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(dx, dy);
  const across = ([x, y]: Place) => Math.abs((x - a[0]) * dy - (y - a[1]) * dx) / length;
  const along = ([x, y]: Place) => ((x - a[0]) * dx + (y - a[1]) * dy) / length;
  const own = distance2(p, q);
  const [from, to] = [along(p), along(q)];
  const common = Math.min(length, Math.max(from, to)) - Math.max(0, Math.min(from, to));
  return {
    distance: Math.max(across(p), across(q)),
    isParallel: Math.abs(to - from) >= PARALLEL * own,
    share: common / own,
  };
}

/** How far a stretch is from an edge that it runs along, pixels; infinite where it does not. */
export function distanceFrom(edge: RoofEdge, view: ViewInfo, stretch: Stretch): number {
  const { distance, isParallel, share } = apart(stretch, [imageIn(view, edge.p0), imageIn(view, edge.p1)]);
  return isParallel && share > 0.6 ? distance : Number.POSITIVE_INFINITY;
}

/** The edge of a roof that a stretch of a view shows; null where it shows none. */
export function edgeShown(view: ViewInfo, stretch: Stretch): RoofEdge | null {
  return nearestOf(EDGES, (edge) => distanceFrom(edge, view, stretch), NEAR_PX);
}

/** Whether a stretch of a view shows this edge. */
export function shows(edge: RoofEdge, view: ViewInfo, stretch: Stretch): boolean {
  return distanceFrom(edge, view, stretch) <= NEAR_PX;
}

/** A 3D line that was found. */
export function lineOf({ results }: Figure, index: number): readonly [Point, Point] | null {
  return lineAt(results.lines, index);
}

/** The edge of a roof along which a 3D line runs. */
export function edgeAlong([p, q]: readonly [Point, Point]): RoofEdge | null {
  const flat = ([x, y]: Point): Place => [x, y];
  return nearestOf(
    EDGES,
    (edge) => {
      const { distance, isParallel, share } = apart([flat(p), flat(q)], [flat(edge.p0), flat(edge.p1)]);
      const heights = Math.max(...[p, q].map((one) => Math.abs(one[2] - heightOn(edge, one))));
      return isParallel && share > 0.6 ? Math.max(distance, heights) : Number.POSITIVE_INFINITY;
    },
    NEAR_M,
  );
}

/** The height of an edge next to a point. */
function heightOn({ p0, p1 }: RoofEdge, [x, y]: Point): number {
  const [dx, dy] = [p1[0] - p0[0], p1[1] - p0[1]];
  const share = ((x - p0[0]) * dx + (y - p0[1]) * dy) / (dx * dx + dy * dy);
  return p0[2] + share * (p1[2] - p0[2]);
}

/** The face of a roof over a point in plan: of several, the highest. */
export function faceOver([x, y]: Place): RoofFace | null {
  const over = FACES.filter(({ polygon }) => isInside([x, y], polygon));
  const height = ({ plane: [a, b, c, d] }: RoofFace) => -(a * x + b * y + d) / c;
  return over.reduce<RoofFace | null>(
    (top, one) => (top !== null && height(top) >= height(one) ? top : one),
    null,
  );
}

/** The face beside a line, and its angle about it, degrees: B99 4.1, as `ThetaFrame` measures it. */
export function faceBeside(
  line: readonly [Point, Point],
  side: Side,
): { face: RoofFace; theta: number } | null {
  const [p, q] = line;
  const { along, left, up } = thetaFrame(p, q);
  const outward = scaled(left, side === "left" ? 1 : -1);
  const [x, y] = add(mix3(p, q, 0.5), outward, 0.6);
  const face = faceOver([x, y]);
  if (face === null) {
    return null;
  }
  const [a, b, c] = face.plane;
  const across = cross([a, b, c], along);
  const sign = dot(across, outward) < 0 ? -1 : 1;
  return { face, theta: Math.atan2(sign * dot(across, up), sign * dot(across, outward)) / DEGREE };
}

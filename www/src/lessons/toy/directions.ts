/** Main directions and clusters in object space, of the drawn house (W96 3.4 and 3.5). */
import { lineThrough } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { type Camera, imageOf, planeOfLine, projection } from "./camera";
import { noisy, stream } from "./evidence";
import { EDGES } from "./house";

interface SeenLine {
  view: number;
  ends: readonly [Vec2, Vec2];
  /** Length in the image, pixels. */
  length: number;
  /** Whether it is noise of the scene. */
  isStray: boolean;
}

/** Level edges of the house turned by `turn` in plan, as the views see them with noise, and lines that are no edges. */
export function seenLines(
  cameras: readonly Camera[],
  turn: number,
  strays: number,
  sigma: number,
): SeenLine[] {
  const random = stream(7);
  const turned = ([x, y, z]: Vec3): Vec3 => [
    x * Math.cos(turn) - y * Math.sin(turn),
    x * Math.sin(turn) + y * Math.cos(turn),
    z,
  ];
  return cameras.flatMap((camera, view) => {
    const measured = (X: Vec3) => noisy(imageOf(camera, turned(X)), sigma, random);
    const edges = EDGES.map(([p, q]) => lineOf(view, measured(p), measured(q), false));
    const others = Array.from({ length: strays }, () => {
      const [x, y, along, size] = [
        random() * camera.width,
        random() * camera.height,
        random() * Math.PI,
        15 + 45 * random(),
      ];
      return lineOf(view, [x, y], [x + size * Math.cos(along), y + size * Math.sin(along)], true);
    });
    return [...edges, ...others];
  });
}

function lineOf(view: number, p: Vec2, q: Vec2, isStray: boolean): SeenLine {
  return { view, ends: [p, q], length: Math.hypot(q[0] - p[0], q[1] - p[1]), isStray };
}

/** Azimuth in which the plane of a line and a projection centre cuts the horizontal, 0 to pi from X. */
export function azimuthOf(camera: Camera, [p, q]: readonly [Vec2, Vec2]): number {
  const { n } = planeOfLine(projection(camera), lineThrough(p, q));
  // The cut of two planes runs along n x (0, 0, 1).
  const angle = Math.atan2(-n[0], n[1]);
  return ((angle % Math.PI) + Math.PI) % Math.PI;
}

/** Lengths of all lines by azimuth. */
export function azimuthHistogram(
  cameras: readonly Camera[],
  lines: readonly SeenLine[],
  bins: number,
): number[] {
  const all = new Array<number>(bins).fill(0);
  for (const { view, ends, length } of lines) {
    const bin = Math.min(bins - 1, Math.floor((azimuthOf(cameras[view] as Camera, ends) / Math.PI) * bins));
    all[bin] = (all[bin] as number) + length;
  }
  return all;
}

/** The sum of the bins at an angle and across it. */
export function crossSum(histogram: readonly number[], alpha: number): number {
  const count = histogram.length;
  const at = (angle: number) => {
    const bin = Math.floor((angle / Math.PI) * count);
    return histogram[((bin % count) + count) % count] as number;
  };
  return at(alpha) + at(alpha + Math.PI / 2);
}

/** The angle, 0 to pi / 2, at which both peaks together are highest. */
export function mainDirection(histogram: readonly number[]): number {
  const half = histogram.length / 2;
  let best = 0;
  for (let bin = 1; bin < half; bin += 1) {
    const sum = (of: number) =>
      (histogram[of] as number) + (histogram[(of + half) % histogram.length] as number);
    if (sum(bin) > sum(best)) {
      best = bin;
    }
  }
  return ((best + 0.5) * Math.PI) / histogram.length;
}

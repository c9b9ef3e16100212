/** How the flat arrays of the core are laid out: numbers per entry, and what their codes stand for. */
import { norm, sub } from "./linear";
import type { Vec2, Vec3 } from "./records";

export const SEGMENT_STRIDE = 4;
export const SUPPORT_STRIDE = 6;
export const LINE_STRIDE = 6;
/** line, then p0 and p1 of a stretch. */
export const STRETCH_STRIDE = 7;
/** x0, y0, x1, y1, reason. */
export const REJECTED_STRIDE = 5;

/** How a stretch of a matched line came about, as `matchedSegments` numbers it. */
export const SUPPORT_KINDS = ["matched", "merged", "grown"] as const;

/** Both ends of a segment of a view; null where there is no such segment. */
export function segmentAt(segments: Float32Array | undefined, index: number): readonly [Vec2, Vec2] | null {
  const at = index * SEGMENT_STRIDE;
  const [x0 = 0, y0 = 0, x1 = 0, y1] = segments?.subarray(at, at + SEGMENT_STRIDE) ?? [];
  return y1 === undefined
    ? null
    : [
        [x0, y0],
        [x1, y1],
      ];
}

/** Both ends of a 3D line, of many that begin at `offset` and have a stride; null where there is no such line. */
export function lineAt(
  lines: Float64Array | null,
  index: number,
  stride = LINE_STRIDE,
  offset = 0,
): readonly [Vec3, Vec3] | null {
  const at = index * stride + offset;
  const [a = 0, b = 0, c = 0, d = 0, e = 0, f] = lines?.subarray(at, at + LINE_STRIDE) ?? [];
  return f === undefined
    ? null
    : [
        [a, b, c],
        [d, e, f],
      ];
}

/** How long a piece of a line is between its ends. */
export const lengthOf = (ends: readonly [Vec2, Vec2] | readonly [Vec3, Vec3] | null): number =>
  ends === null ? 0 : norm(sub<readonly number[]>(ends[1], ends[0]));

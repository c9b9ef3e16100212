/** Where photographs were taken by their headers, seen from above. */
import type { ImageReport } from "../../../shared/records";

/** An image and what its header says of where, when and with what it was taken. */
export type Photograph = Pick<ImageReport, "path" | "stated">;

/** A photograph in plan, metres east and north of the middle of all. */
interface PlanPoint {
  path: string;
  east: number;
  north: number;
}

const METRES_PER_DEGREE = 111_320;

/** Positions in plan, in the order in which they were taken: the way that was flown. */
export function planOf(all: readonly Photograph[]): PlanPoint[] {
  const placed = all.flatMap(({ path, stated: { position, taken } }) =>
    position === null ? [] : [{ path, position, time: taken ?? "" }],
  );
  const mean = (axis: 0 | 1) => placed.reduce((sum, { position }) => sum + position[axis], 0) / placed.length;
  const [longitude, latitude] = [mean(0), mean(1)];
  const shrink = Math.cos((latitude * Math.PI) / 180);
  const isBefore = (a: string, b: string) => (a < b ? -1 : 1);
  return placed
    .sort((a, b) => (a.time === b.time ? isBefore(a.path, b.path) : isBefore(a.time, b.time)))
    .map(({ path, position }) => ({
      path,
      east: (position[0] - longitude) * METRES_PER_DEGREE * shrink,
      north: (position[1] - latitude) * METRES_PER_DEGREE,
    }));
}

/** 1, 2 or 5 times a power of ten, metres: the longest bar that is no longer than a quarter of the plan. */
export function scaleBarM(extentM: number): number {
  const longest = Math.max(extentM, 1) / 4;
  const power = 10 ** Math.floor(Math.log10(longest));
  return power * ([5, 2].find((step) => step * power <= longest) ?? 1);
}

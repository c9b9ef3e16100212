/** A plan of positions on a square drawing. */
import type { Vec3 } from "../../../../shared/records";

/** Where positions stand on a drawing of `side` with a margin, y of the world upwards. */
export function drawnPlan(positions: readonly Vec3[], side: number, margin: number): [number, number][] {
  const range = (axis: 0 | 1) => {
    const values = positions.map((position) => position[axis]);
    return [Math.min(...values), Math.max(...values)] as const;
  };
  const [west, east] = range(0);
  const [south, north] = range(1);
  const extent = Math.max(east - west, north - south) || 1;
  const scale = (side - 2 * margin) / extent;
  return positions.map(([x, y]) => [
    side / 2 + (x - (west + east) / 2) * scale,
    side / 2 - (y - (south + north) / 2) * scale,
  ]);
}

/** Longest arrow of a plan, as a share of its extent. */
const LONGEST = 1 / 6;

/** By how much offsets are drawn too long on a plan of positions: 1, 2 or 5 times a power of ten. */
export function exaggeration(
  positions: readonly (readonly [number, number])[],
  offsets: readonly (readonly [number, number])[],
): number {
  const extent = (axis: 0 | 1) => {
    const values = positions.map((position) => position[axis]);
    return Math.max(...values) - Math.min(...values);
  };
  const longest = Math.max(...offsets.map(([x, y]) => Math.hypot(x, y)));
  const most = (LONGEST * Math.max(extent(0), extent(1))) / longest;
  if (!(most > 0 && Number.isFinite(most))) {
    return 1;
  }
  const power = 10 ** Math.floor(Math.log10(most));
  return power * ([5, 2].find((digit) => digit * power <= most) ?? 1);
}

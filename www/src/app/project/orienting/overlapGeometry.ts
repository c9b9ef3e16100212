/** A plan of positions on a square drawing. */
import type { Vec3 } from "../../../shared/records";

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

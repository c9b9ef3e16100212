/** Roofs over a rectangular plan: each eave carries a half-plane, and the lowest one is the roof. */
import { rectangle } from "../../shared/linear";

/** Half of the plan's length and width, metres, and the height of its eaves. */
export const PLAN = { length: 7, width: 4, eave: 5 } as const;

export const SIDES = ["south", "east", "north", "west"] as const;
export type SideName = (typeof SIDES)[number];
/** Slopes of the four half-planes, radians; null: the side carries none (a gable). */
export type Slopes = Readonly<Record<SideName, number | null>>;

/** Distance of a place from an eave, inwards, metres. */
export function inwards(side: SideName, x: number, y: number): number {
  const { length, width } = PLAN;
  return { south: y + width, north: width - y, east: length - x, west: x + length }[side];
}

/** Height of a half-plane at a place. */
export function heightOf(side: SideName, slope: number, x: number, y: number): number {
  return PLAN.eave + Math.tan(slope) * inwards(side, x, y);
}

export type Corner = readonly [x: number, y: number];

/** The part of the plan that a half-plane covers: where none of the others is lower. */
export function facetOf(slopes: Slopes, side: SideName): readonly Corner[] {
  const { length, width } = PLAN;
  const own = slopes[side];
  let ring: readonly Corner[] = rectangle([-length, -width], [length, width]);
  if (own === null) {
    return [];
  }
  for (const other of SIDES) {
    const slope = slopes[other];
    if (other !== side && slope !== null) {
      ring = cut(ring, ([x, y]) => heightOf(other, slope, x, y) - heightOf(side, own, x, y));
    }
  }
  return ring;
}

/** The part of a convex ring where a linear function is not negative. */
function cut(ring: readonly Corner[], value: (at: Corner) => number): Corner[] {
  return ring.flatMap((p, i) => {
    const q = ring[(i + 1) % ring.length] as Corner;
    const [a, b] = [value(p), value(q)];
    const kept: Corner[] = a >= 0 ? [p] : [];
    if (a * b < 0) {
      const t = a / (a - b);
      kept.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
    }
    return kept;
  });
}

/** Distance from the south eave, and height, of the ridge between the south and the north half-plane. */
export function ridgeOf(south: number, north: number): { inwards: number; z: number } {
  const [s, n] = [Math.tan(south), Math.tan(north)];
  const across = 2 * PLAN.width;
  const from = (n * across) / (s + n);
  return { inwards: from, z: PLAN.eave + s * from };
}

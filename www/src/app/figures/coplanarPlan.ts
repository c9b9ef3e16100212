/** What the plan of coplanar sets shows, and what is picked there. */
import type { CoplanarSets, Vec2, Vec3 } from "../../shared/records";
import { isVerified } from "../../viewer/layers/coplanar";

/** The hull of the lines' ends, the polygon that was made of it, or one over the other. */
export type CoplanarOutlines = "hull" | "polygon" | "both";

/** The verified sets, and that which is picked. */
export function shownSets({ sets }: CoplanarSets, picked: number | null): number[] {
  return sets.flatMap((set, index) => (isVerified(set) || index === picked ? [index] : []));
}

/** The verified set at a place of the plan: of several the one with the most nats; null where there is none. */
export function setAt(coplanar: CoplanarSets, at: Vec2): number | null {
  const nats = (index: number) => {
    const set = coplanar.sets[index];
    return set === undefined ? 0 : set.inside_nats + set.outline_nats;
  };
  const over = shownSets(coplanar, null).filter((index) => holds(coplanar.sets[index]?.polygon ?? [], at));
  return over.sort((a, b) => nats(b) - nats(a))[0] ?? null;
}

/** Is a place inside a convex ring, counter-clockwise? */
function holds(ring: readonly Vec3[], [x, y]: Vec2): boolean {
  return ring.every(([ax, ay], i) => {
    const [bx, by] = ring[(i + 1) % ring.length] as Vec3;
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0;
  });
}

/** What the plan of coplanar sets shows, and what is picked there. */
import { edgesOf, planArea } from "../../shared/linear";
import { isVerifiedSet } from "../../shared/proposed";
import type { CoplanarSets, Vec2, Vec3 } from "../../shared/records";

/** The hull of the lines' ends, the polygon that was made of it, or one over the other. */
export type CoplanarOutlines = "hull" | "polygon" | "both";

/** The verified sets, and that which is picked; the largest first, for the ground is one that holds all others. */
export function shownSets({ sets }: CoplanarSets, picked: number | null): number[] {
  const shown = sets.flatMap((set, index) => (isVerifiedSet(set) || index === picked ? [index] : []));
  const area = (index: number) => planArea(sets[index]?.polygon ?? []);
  return shown.sort((a, b) => area(b) - area(a));
}

/** The smallest verified set at a place of the plan; null where there is none. */
export function setAt(coplanar: CoplanarSets, at: Vec2): number | null {
  const over = shownSets(coplanar, null).filter((index) => holds(coplanar.sets[index]?.polygon ?? [], at));
  return over.at(-1) ?? null;
}

/** Is a place inside a convex ring, counter-clockwise? */
function holds(ring: readonly Vec3[], [x, y]: Vec2): boolean {
  return edgesOf(ring).every(([[ax, ay], [bx, by]]) => (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0);
}

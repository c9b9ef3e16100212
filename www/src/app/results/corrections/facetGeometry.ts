/** Where a facet, its corners and its edges are, in words of the core's corrections: by their place in the world. */
import { add, dot, edgesOf, isInside, mix3, norm, sub } from "../../../shared/linear";
import type { Facet, FacetPlace, Vec3 } from "../../../shared/records";
import { heightAt } from "../../../shared/surfaceClass";

export type Ends = readonly [Vec3, Vec3];

export function middle([a, b]: Ends): Vec3 {
  return mix3(a, b, 0.5);
}

/** A point well inside a facet, local frame: the middle of its broadest stretch from west to east at half its depth. */
export function innerPoint(facet: Facet): Vec3 {
  const rings = [facet.outer, ...facet.holes];
  const ys = facet.outer.map(([, y]) => y);
  const [low, high] = [Math.min(...ys), Math.max(...ys)];
  // Not through a corner, as the middle of a symmetric roof may be.
  const y = low + 0.497 * (high - low);
  const crossings = rings
    .flatMap((ring) =>
      edgesOf(ring).flatMap(([p, q]) =>
        p[1] > y === q[1] > y ? [] : [p[0] + ((q[0] - p[0]) * (y - p[1])) / (q[1] - p[1])],
      ),
    )
    .sort((a, b) => a - b);
  let broadest: readonly [number, number] = [crossings[0] ?? 0, crossings[1] ?? 0];
  for (let i = 2; i + 1 < crossings.length; i += 2) {
    const stretch = [crossings[i] as number, crossings[i + 1] as number] as const;
    broadest = stretch[1] - stretch[0] > broadest[1] - broadest[0] ? stretch : broadest;
  }
  const x = (broadest[0] + broadest[1]) / 2;
  return [x, y, heightAt(facet, x, y)];
}

export function placeOf(facet: Facet, origin: Vec3): FacetPlace {
  return { at: add(innerPoint(facet), origin), normal: facet.plane.normal };
}

/** The facet that covers a place in plan; -1 for none. */
export function facetAt(facets: readonly Facet[], at: readonly number[]): number {
  const covers = (ring: readonly Vec3[]) => isInside(at, ring);
  return facets.findIndex(({ outer, holes }) => covers(outer) && !holes.some(covers));
}

/** Two corners nearer than this are one, metres. */
const SAME_M = 0.02;

function isSame(p: Vec3, q: Vec3): boolean {
  return norm(sub(p, q)) < SAME_M;
}

/** The edges of a facet that it shares with none, in space. */
export function freeEdges(facets: readonly Facet[], index: number): Ends[] {
  const own = facets[index];
  const others = facets.filter((_, i) => i !== index);
  const isShared = ([p, q]: Ends) =>
    others.some(({ outer, holes }) =>
      [outer, ...holes].some((ring) => edgesOf(ring).some(([a, b]) => isSame(p, b) && isSame(q, a))),
    );
  return edgesOf(own?.outer ?? []).filter((edge) => !isShared(edge));
}

/** Edges whose heights differ by less are as high as each other, metres: as near as an edge is found again. */
const AS_HIGH_M = 0.4;

/** The free edge of a facet beyond which its counterpart would lie: the longest of the highest level ones. */
export function ridgeOf(facets: readonly Facet[], index: number): Ends | null {
  const level = freeEdges(facets, index).filter(([p, q]) => {
    const [dx, dy, dz] = sub(q, p);
    return Math.abs(dz) < 0.1 * Math.hypot(dx, dy);
  });
  const height = (edge: Ends) => middle(edge)[2];
  const highest = Math.max(...level.map(height));
  const length = ([p, q]: Ends) => norm(sub(q, p));
  // A ridge may turn by a step at its end, which is as high as the ridge.
  return level
    .filter((edge) => height(edge) > highest - AS_HIGH_M)
    .reduce<Ends | null>((best, edge) => (best === null || length(edge) > length(best) ? edge : best), null);
}

/** The ends of edges as a ring that does not cross itself: the second edge is turned where needed. */
export function ringOf([a, b]: Ends, [c, d]: Ends): Vec3[] {
  const length = (p: Vec3, q: Vec3) => norm(sub(p, q));
  return length(b, c) + length(d, a) <= length(b, d) + length(c, a) ? [a, b, c, d] : [a, b, d, c];
}

/** The free edge of a facet whose middle is nearest to that of another edge. */
export function nearestEdge(facets: readonly Facet[], index: number, to: Ends): Ends | null {
  const off = (edge: Ends) => norm(sub(middle(edge), middle(to)));
  return freeEdges(facets, index).reduce<Ends | null>(
    (best, edge) => (best === null || off(edge) < off(best) ? edge : best),
    null,
  );
}

/** The longest edge of a ring, and the other one that is most nearly parallel to it: their numbers, that one first. */
export function nearestParallel(ring: readonly Vec3[]): [turned: number, kept: number] {
  const along = edgesOf(ring).map(([p, q]) => sub(q, p));
  const longest = along.reduce((best, v, i) => (norm(v) > norm(along[best] as Vec3) ? i : best), 0);
  const cosine = (v: Vec3) => Math.abs(dot(along[longest] as Vec3, v)) / norm(v);
  const others = along.map((_, i) => i).filter((i) => i !== longest);
  const turned = others.reduce((best, i) =>
    cosine(along[i] as Vec3) > cosine(along[best] as Vec3) ? i : best,
  );
  return [turned, longest];
}

/** Where a facet, its corners and its edges are, in words of the core's corrections: by their place in the world. */
import type { Facet, FacetPlace, Vec3 } from "../../../shared/records";

export type Ends = readonly [Vec3, Vec3];

export function sum(a: Vec3, b: Vec3): Vec3 {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

export function difference(a: Vec3, b: Vec3): Vec3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

export function middle([a, b]: Ends): Vec3 {
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];
}

/** Height of a facet's plane at a place in plan. */
function heightAt({ plane: { normal, d } }: Facet, x: number, y: number): number {
  return -(normal[0] * x + normal[1] * y + d) / normal[2];
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
  return { at: sum(innerPoint(facet), origin), normal: facet.plane.normal };
}

export function edgesOf(ring: readonly Vec3[]): Ends[] {
  return ring.map((p, i) => [p, ring[(i + 1) % ring.length] as Vec3]);
}

/** The facet that covers a place in plan; -1 for none. */
export function facetAt(facets: readonly Facet[], [x, y]: readonly number[]): number {
  const covers = (ring: readonly Vec3[]) =>
    edgesOf(ring).reduce((odd, [p, q]) => {
      const [px, py, qx, qy] = [p[0], p[1], q[0], q[1]];
      const at = (y ?? 0) as number;
      const crosses = py > at !== qy > at && (x ?? 0) < px + ((qx - px) * (at - py)) / (qy - py);
      return odd !== crosses;
    }, false);
  return facets.findIndex(({ outer, holes }) => covers(outer) && !holes.some(covers));
}

/** Two corners nearer than this are one, metres. */
const SAME_M = 0.02;

function isSame(p: Vec3, q: Vec3): boolean {
  return Math.hypot(...difference(p, q)) < SAME_M;
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
    const [dx, dy, dz] = difference(q, p);
    return Math.abs(dz) < 0.1 * Math.hypot(dx, dy);
  });
  const height = (edge: Ends) => middle(edge)[2];
  const highest = Math.max(...level.map(height));
  const length = ([p, q]: Ends) => Math.hypot(...difference(q, p));
  // A ridge may turn by a step at its end, which is as high as the ridge.
  return level
    .filter((edge) => height(edge) > highest - AS_HIGH_M)
    .reduce<Ends | null>((best, edge) => (best === null || length(edge) > length(best) ? edge : best), null);
}

/** The ends of edges as a ring that does not cross itself: the second edge is turned where needed. */
export function ringOf([a, b]: Ends, [c, d]: Ends): Vec3[] {
  const length = (p: Vec3, q: Vec3) => Math.hypot(...difference(p, q));
  return length(b, c) + length(d, a) <= length(b, d) + length(c, a) ? [a, b, c, d] : [a, b, d, c];
}

/** The free edge of a facet whose middle is nearest to that of another edge. */
export function nearestEdge(facets: readonly Facet[], index: number, to: Ends): Ends | null {
  const off = (edge: Ends) => Math.hypot(...difference(middle(edge), middle(to)));
  return freeEdges(facets, index).reduce<Ends | null>(
    (best, edge) => (best === null || off(edge) < off(best) ? edge : best),
    null,
  );
}

/** The longest edge of a ring, and the other one that is most nearly parallel to it: their numbers, that one first. */
export function nearestParallel(ring: readonly Vec3[]): [turned: number, kept: number] {
  const along = edgesOf(ring).map(([p, q]) => difference(q, p));
  const length = (v: Vec3) => Math.hypot(...v);
  const longest = along.reduce((best, v, i) => (length(v) > length(along[best] as Vec3) ? i : best), 0);
  const [kx, ky, kz] = along[longest] as Vec3;
  const cosine = ([x, y, z]: Vec3) => Math.abs(kx * x + ky * y + kz * z) / length([x, y, z]);
  const others = along.map((_, i) => i).filter((i) => i !== longest);
  const turned = others.reduce((best, i) =>
    cosine(along[i] as Vec3) > cosine(along[best] as Vec3) ? i : best,
  );
  return [turned, longest];
}

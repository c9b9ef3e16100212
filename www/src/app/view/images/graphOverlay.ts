/** What is drawn of an adjacency graph over its image (B99 2: Bonn), and which of it was found again in other views. */
import type { AdjacencyGraphs, ImageGraph, Vec2 } from "../../../shared/records";

/** A corner of the image, and the corner in space that it shows, if any. */
interface GraphCorner {
  at: Vec2;
  space: number | null;
}

export interface GraphOverlay {
  corners: readonly GraphCorner[];
  /** Ends of each edge, pixels, and whether it is an edge of a corner in space. */
  edges: readonly { ends: readonly [Vec2, Vec2]; isMatched: boolean }[];
  /** The part of a region between two edges, pixels; sectors of one region have its number. */
  sectors: readonly { ring: readonly Vec2[]; region: number }[];
}

/** Sectors reach so far from their corner, pixels, or half as far as the shorter edge. */
const REACH_PX = 14;
const ARC_STEPS = 6;

/** The graph of a view. */
export function graphOverlay({ trace }: AdjacencyGraphs, view: number): GraphOverlay | null {
  const graph = trace.graphs[view];
  if (graph === undefined) {
    return null;
  }
  const space = new Map<number, number>();
  const matched = new Set<string>();
  for (const [index, { images, edges }] of trace.corners.entries()) {
    const own = images.find(([v]) => v === view)?.[1];
    if (own !== undefined) {
      space.set(own, index);
      for (const [, edge] of edges.flatMap((one) => one.images).filter(([v]) => v === view)) {
        matched.add(`${own} ${edge}`);
      }
    }
  }
  return {
    corners: graph.corners.map(({ at }, i) => ({ at, space: space.get(i) ?? null })),
    edges: graph.corners.flatMap(({ at, edges }, i) =>
      edges.map(({ far }, k) => ({ ends: [at, far] as const, isMatched: matched.has(`${i} ${k}`) })),
    ),
    sectors: graph.corners.flatMap((corner) => sectorsOf(corner)),
  };
}

/** The corner in space that is shown nearest to a place of the image; null where none is within reach. */
export function cornerAt({ corners }: GraphOverlay, [x, y]: Vec2, reach: number): number | null {
  const near = corners
    .map(({ at, space }) => ({ space, off: Math.hypot(at[0] - x, at[1] - y) }))
    .filter(({ space, off }) => space !== null && off <= reach)
    .sort((a, b) => a.off - b.off);
  return near[0]?.space ?? null;
}

function sectorsOf({ at, edges }: ImageGraph["corners"][number]): GraphOverlay["sectors"][number][] {
  return edges.map(({ direction: [dx, dy], far, region }, k) => {
    const next = edges[(k + 1) % edges.length] as (typeof edges)[number];
    const length = (end: Vec2) => Math.hypot(end[0] - at[0], end[1] - at[1]);
    const reach = Math.min(REACH_PX, length(far) / 2, length(next.far) / 2);
    const from = Math.atan2(dy, dx);
    const turn = Math.atan2(next.direction[1], next.direction[0]) - from;
    const opening = turn > 0 ? turn : turn + 2 * Math.PI;
    const arc = Array.from({ length: ARC_STEPS + 1 }, (_, i): Vec2 => {
      const angle = from + (opening * i) / ARC_STEPS;
      return [at[0] + reach * Math.cos(angle), at[1] + reach * Math.sin(angle)];
    });
    return { ring: [at, ...arc], region };
  });
}

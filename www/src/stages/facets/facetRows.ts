import { planeOf, type Row } from "../../app/results/takeAlong/rows";
import type { Figure } from "../figure";

/** Corners of the facets, in their order. */
export function facetRows({ results: { facets } }: Figure): Row[] {
  return (facets ?? []).flatMap(({ outer, plane, similarity, real_ratio, probability }, facet) =>
    outer.map(([x, y, z], corner) => ({
      facet,
      corner,
      x,
      y,
      z,
      ...planeOf(plane),
      similarity,
      real_ratio,
      probability,
    })),
  );
}

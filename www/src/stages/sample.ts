/** The simplest things that layers are made of, for those whose shaders are made when the page opens. */
import type { Facet } from "../shared/records";

/** Ends of two lines. */
export const ENDS = Float64Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0);

export const PLANE = { normal: [0, 0, 1], d: 0 } as const;

export const FACET: Facet = {
  building: 0,
  plane: PLANE,
  outer: [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
  ],
  holes: [],
  similarity: 1,
  real_ratio: 1,
  probability: 1,
  uncertainty: null,
  lines: [],
  half_planes: [],
  proposals: [],
  obstructions: [],
};

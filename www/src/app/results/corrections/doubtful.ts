/** Which facets are doubtful, and in which order they are looked at. */
import type { Facet } from "../../../shared/records";

/** Facets that are less probable are doubtful: one false one in twenty. */
const DOUBTFUL = 0.95;

/** The doubtful facets, the least probable first. */
export function doubtfulFacets(facets: readonly Pick<Facet, "probability">[]): number[] {
  return facets
    .map(({ probability }, index) => ({ probability, index }))
    .filter(({ probability }) => probability < DOUBTFUL)
    .sort((a, b) => a.probability - b.probability || a.index - b.index)
    .map(({ index }) => index);
}

/** The one after the present one, the first after the last; null where nothing is doubtful. */
export function nextDoubtful(
  facets: readonly Pick<Facet, "probability">[],
  present: number | null,
): number | null {
  const order = doubtfulFacets(facets);
  const at = present === null ? -1 : order.indexOf(present);
  return order[(at + 1) % order.length] ?? null;
}

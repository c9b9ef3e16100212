/** Places in a pair of photographs. */

/**
 * The match nearest to a place in one of the photographs; 0 where there are none.
 * @param matches x, y in the first and x, y in the second photograph, pixels
 */
export function nearestMatch(matches: Float32Array, side: 0 | 1, x: number, y: number): number {
  let nearest = 0;
  let least = Number.POSITIVE_INFINITY;
  for (let match = 0; 4 * match + 3 < matches.length; match += 1) {
    const at = 4 * match + 2 * side;
    const distance = Math.hypot((matches[at] as number) - x, (matches[at + 1] as number) - y);
    if (distance < least) {
      [nearest, least] = [match, distance];
    }
  }
  return nearest;
}

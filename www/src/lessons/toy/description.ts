/** Description length of a row of grey values cut into stretches of constant grey (W96 3.3, one dimension). */

/** Bits for the place of a break among n pixels, and for a grey value. */
const GREY_BITS = 8;

interface Description {
  /** Bits that state the stretches: breaks and grey values. */
  model: number;
  /** Bits that state what the pixels deviate by. */
  data: number;
  total: number;
}

/**
 * Bits of the whole description.
 * @param breaks places where a new stretch begins, rising, within the row
 * @param sigma standard deviation of the noise, grey values; pixels are stated to whole values
 */
export function describe(row: readonly number[], breaks: readonly number[], sigma: number): Description {
  const ends = [0, ...breaks, row.length];
  let squares = 0;
  for (let i = 0; i + 1 < ends.length; i += 1) {
    const part = row.slice(ends[i], ends[i + 1]);
    const mean = part.reduce((sum, one) => sum + one, 0) / part.length;
    squares += part.reduce((sum, one) => sum + (one - mean) ** 2, 0);
  }
  const model = breaks.length * Math.log2(row.length) + (breaks.length + 1) * GREY_BITS;
  const data = (row.length / 2) * Math.log2(2 * Math.PI * sigma ** 2) + squares / (2 * sigma ** 2 * Math.LN2);
  return { model, data, total: model + data };
}

/** Cuts everywhere, then drops the break that saves most, while any saves: the greedy moves of W96. */
export function shortest(row: readonly number[], sigma: number): number[] {
  let breaks = Array.from({ length: row.length - 1 }, (_, i) => i + 1);
  for (;;) {
    const now = describe(row, breaks, sigma).total;
    let best = { total: now, without: -1 };
    breaks.forEach((_, i) => {
      const { total } = describe(row, breaks.toSpliced(i, 1), sigma);
      if (total < best.total) {
        best = { total, without: i };
      }
    });
    if (best.without < 0) {
      return breaks;
    }
    breaks = breaks.toSpliced(best.without, 1);
  }
}

/** Breaks by their number: from one everywhere, dropping the one that leaves the least deviations. */
export function byCount(row: readonly number[], sigma: number): ReadonlyMap<number, readonly number[]> {
  let now = Array.from({ length: row.length - 1 }, (_, i) => i + 1);
  const all = new Map<number, readonly number[]>();
  while (now.length > 0) {
    const from = now;
    let best = { data: Number.POSITIVE_INFINITY, without: 0 };
    from.forEach((_, i) => {
      const { data } = describe(row, from.toSpliced(i, 1), sigma);
      if (data < best.data) {
        best = { data, without: i };
      }
    });
    now = from.toSpliced(best.without, 1);
    all.set(now.length, now);
  }
  return all;
}

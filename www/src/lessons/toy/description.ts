/** Description length of a row of grey values cut into stretches of constant grey (W96 3.3, one dimension). */
import { meanOf } from "./windows";

/** Bits for the place of a break among n pixels, and for a grey value. */
const GREY_BITS = 8;

interface Description {
  /** Bits that state the stretches: breaks and grey values. */
  model: number;
  /** Bits that state what the pixels deviate by. */
  data: number;
  total: number;
}

/** The stretches between breaks, and the mean of each. */
export function stretchesOf(row: readonly number[], breaks: readonly number[]) {
  const starts = [0, ...breaks];
  return starts.map((from, i) => {
    const to = starts[i + 1] ?? row.length;
    return { from, to, mean: meanOf(row.slice(from, to)) };
  });
}

/**
 * Bits of the whole description.
 * @param breaks places where a new stretch begins, rising, within the row
 * @param sigma standard deviation of the noise, grey values; pixels are stated to whole values
 */
export function describe(row: readonly number[], breaks: readonly number[], sigma: number): Description {
  const squares = stretchesOf(row, breaks).reduce(
    (sum, { from, to, mean }) => row.slice(from, to).reduce((all, one) => all + (one - mean) ** 2, sum),
    0,
  );
  const model = breaks.length * Math.log2(row.length) + (breaks.length + 1) * GREY_BITS;
  const data = (row.length / 2) * Math.log2(2 * Math.PI * sigma ** 2) + squares / (2 * sigma ** 2 * Math.LN2);
  return { model, data, total: model + data };
}

/** Cuts everywhere, then drops the break that saves most, while any saves: the greedy moves of W96. */
export function shortest(row: readonly number[], sigma: number): readonly number[] {
  const total = (breaks: readonly number[]) => describe(row, breaks, sigma).total;
  let now = everywhere(row);
  for (const fewer of byCount(row, sigma).values()) {
    if (total(fewer) >= total(now)) {
      return now;
    }
    now = fewer;
  }
  return now;
}

/** Breaks by their number: from one everywhere, dropping the one that leaves the least deviations. */
export function byCount(row: readonly number[], sigma: number): ReadonlyMap<number, readonly number[]> {
  let now = everywhere(row);
  const all = new Map<number, readonly number[]>();
  while (now.length > 0) {
    const fewer = now.map((_, i) => now.toSpliced(i, 1));
    const data = fewer.map((breaks) => describe(row, breaks, sigma).data);
    now = fewer[data.indexOf(Math.min(...data))] as readonly number[];
    all.set(now.length, now);
  }
  return all;
}

const everywhere = (row: readonly number[]): readonly number[] => row.slice(1).map((_, i) => i + 1);

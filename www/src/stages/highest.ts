import type { IndexedKind, Selection } from "../shared/selection";

/** The thing of the highest score that is more than nothing; null where there is none. */
export function highest<T>(
  kind: IndexedKind,
  all: readonly T[] | null | undefined,
  score: (one: T) => number,
): Selection | null {
  const scores = all?.map(score) ?? [];
  const most = Math.max(0, ...scores);
  return most === 0 ? null : { kind, index: scores.indexOf(most) };
}

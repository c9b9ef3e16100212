/** The place of the highest score that is more than nothing; -1 where there is none. */
export function highest<T>(all: readonly T[] | null | undefined, score: (one: T) => number): number {
  const scores = all?.map(score) ?? [];
  const most = Math.max(0, ...scores);
  return most === 0 ? -1 : scores.indexOf(most);
}

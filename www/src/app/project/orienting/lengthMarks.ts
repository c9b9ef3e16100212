/** The two ends of a length, as they are marked in photographs. */
import type { LengthMark } from "../../../shared/orientation";

export type End = 0 | 1;
export type Ends = readonly [readonly LengthMark[], readonly LengthMark[]];

export const NO_MARKS: Ends = [[], []];

/** Marks an end in a photograph; an earlier mark of it there is replaced. */
export function marked([first, second]: Ends, end: End, mark: LengthMark): Ends {
  const withMark = (marks: readonly LengthMark[]) => [
    ...marks.filter(({ file }) => file !== mark.file),
    mark,
  ];
  return end === 0 ? [withMark(first), second] : [first, withMark(second)];
}

export function markIn(ends: Ends, end: End, file: string): LengthMark | undefined {
  return ends[end].find((mark) => mark.file === file);
}

/** The end to mark next: the other one as soon as this one is marked in both photographs that are shown. */
export function nextEnd(ends: Ends, end: End, shown: readonly string[]): End {
  const isWhole = (which: End) => shown.every((file) => markIn(ends, which, file) !== undefined);
  const other: End = end === 0 ? 1 : 0;
  return isWhole(end) && !isWhole(other) ? other : end;
}

/** Is each end marked in two photographs or more? */
export function isMeasurable(ends: Ends): boolean {
  return ends.every((marks) => marks.length >= 2);
}

/** The tour: lines grow. */
import { results } from "../../app/state/results";
import { beforeGrowing, selection, showBeforeGrowing } from "../../app/state/viewState";
import { LINE_STRIDE, STRETCH_STRIDE } from "../../shared/flatArrays";
import { numberOf } from "../../shared/selection";
import type { Results } from "../list";
import type { StageStep } from "../tourStep";

const GREW_M = 0.5;

export default [
  {
    title: "Merging and growing",
    text: "A 3D line collects fragments from all views: where one view has a gap, another has not.",
    question: `Switch between Before growing and After, and pick a line that became at least ${GREW_M} m longer.`,
    answer: () => {
      const { line, before, after } = pickedLine();
      return `Line ${numberOf(line ?? 0)} showed ${before.toFixed(1)} m in one piece before, and is ${after.toFixed(1)} m long now.`;
    },
    hint: () => {
      const { line, before, after } = pickedLine();
      if (line === null) {
        return null;
      }
      return beforeGrowing.value
        ? "This is before growing."
        : `Line ${numberOf(line)} is ${after.toFixed(1)} m long, ${before.toFixed(1)} m before: look for one that gained more.`;
    },
    pointsTo: "growing",
    prepare: () => {
      showBeforeGrowing(true);
    },
    isFound: () => {
      const { line, before, after } = pickedLine();
      return !beforeGrowing.value && line !== null && before > 0 && after - before >= GREW_M;
    },
  },
] satisfies readonly StageStep[];

function pickedLine(): { line: number | null; before: number; after: number } {
  const picked = selection.value;
  return picked?.kind === "line"
    ? { line: picked.index, ...growthOf(results.value, picked.index) }
    : { line: null, before: 0, after: 0 };
}

/** Longest stretch of a 3D line that segments showed before growing, and its length now, metres. */
export function growthOf(
  { lines, stretches }: Pick<Results, "lines" | "stretches">,
  line: number,
): { before: number; after: number } {
  const own = stretches ?? new Float64Array();
  let before = 0;
  for (let at = 0; at < own.length; at += STRETCH_STRIDE) {
    if (own[at] === line) {
      before = Math.max(before, lengthAt(own, at + 1));
    }
  }
  return { before, after: lines === null ? 0 : lengthAt(lines, line * LINE_STRIDE) };
}

function lengthAt(numbers: Float64Array, at: number): number {
  const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0] = numbers.subarray(at, at + LINE_STRIDE);
  return Math.hypot(d - a, e - b, f - c);
}

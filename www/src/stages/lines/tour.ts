/** The tour: lines grow. */
import { results } from "../../app/state/results";
import { beforeGrowing, selection, showBeforeGrowing } from "../../app/state/viewState";
import { lengthOf, lineAt, STRETCH_STRIDE } from "../../shared/flatArrays";
import { numberOf, pickedIndex } from "../../shared/selection";
import type { Results } from "../list";
import { ofPicked, type StageStep } from "../tourStep";

const GREW_M = 0.5;

export default [
  {
    title: "Merging and growing",
    text: "A 3D line collects fragments from all views: where one view has a gap, another has not.",
    question: `Switch between Before growing and After, and pick a line that became at least ${GREW_M} m longer.`,
    ...ofPicked(pickedLine, {
      answer: ({ line, before, after }) =>
        `Line ${numberOf(line)} showed ${before.toFixed(1)} m in one piece before, and is ${after.toFixed(1)} m long now.`,
      hint: ({ line, before, after }) =>
        beforeGrowing.value
          ? "This is before growing."
          : `Line ${numberOf(line)} is ${after.toFixed(1)} m long, ${before.toFixed(1)} m before: look for one that gained more.`,
      isFound: ({ before, after }) => !beforeGrowing.value && before > 0 && after - before >= GREW_M,
    }),
    pointsTo: "growing",
    prepare: () => {
      showBeforeGrowing(true);
    },
  },
] satisfies readonly StageStep[];

function pickedLine() {
  const line = pickedIndex(selection.value, "line");
  return line < 0 ? null : { line, ...growthOf(results.value, line) };
}

/** Longest stretch of a 3D line that segments showed before growing, and its length now, metres. */
export function growthOf(
  { lines, stretches }: Pick<Results, "lines" | "stretches">,
  line: number,
): { before: number; after: number } {
  const count = (stretches?.length ?? 0) / STRETCH_STRIDE;
  const own = Array.from({ length: count }, (_, i) => i).filter(
    (i) => stretches?.[i * STRETCH_STRIDE] === line,
  );
  const lengths = own.map((i) => lengthOf(lineAt(stretches, i, STRETCH_STRIDE, 1)));
  return { before: Math.max(0, ...lengths), after: lengthOf(lineAt(lines, line)) };
}

/** The tour: faces from coplanar lines. */
import { counted } from "../../app/parts/counted";
import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { coplanarSetsOf } from "../../shared/records";
import { pickedIndex } from "../../shared/selection";
import type { Results } from "../list";
import { ofPicked, type StageStep } from "../tourStep";

export default [
  {
    title: "Coplanar lines",
    text: "Another partner of the project looked for faces, not for half-planes: lines that lie in one plane are grouped, the convex hull of their ends is closed to a polygon by right angles and symmetry, and the photographs verify it.",
    question:
      "Pick a polygon of a facet of the model in which a side without a line was made square or mirrored.",
    ...ofPicked(() => coplanarSetParts(results.value, pickedIndex(selection.value, "coplanar")), {
      answer: ({ lines, moved }) =>
        `${counted(lines, "lines")} lie in one plane. ${counted(moved, "sides")} without a line close their polygon, by right angles or symmetry.`,
      hint: ({ moved }) =>
        moved === 0
          ? "Every side of this one lies on a line: look for another."
          : "No facet of the model has this polygon: it may lie on the ground.",
      isFound: ({ moved, facets }) => moved > 0 && facets.length > 0,
    }),
  },
] satisfies readonly StageStep[];

/** What a set of coplanar lines is; null where there is none. */
export function coplanarSetParts({ coplanar, facets }: Pick<Results, "coplanar" | "facets">, index: number) {
  const [set, trace] = [coplanar?.sets[index], coplanar?.trace.sets[index]];
  if (set === undefined || trace === undefined) {
    return null;
  }
  return {
    lines: set.lines.length,
    /** Sides without a line that were made square or mirrored. */
    moved: trace.closing.length,
    /** The facets that it proposed. */
    facets: (facets ?? []).flatMap((facet, i) => (coplanarSetsOf(facet).includes(index) ? [i] : [])),
  };
}

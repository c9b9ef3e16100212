/** The tour: half-planes that share a plane. */
import { counted } from "../../app/parts/counted";
import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { isMadeFrom } from "../../shared/records";
import { numberOf, pickedIndex } from "../../shared/selection";
import type { Results } from "../list";
import type { StageStep } from "../tourStep";

export default [
  {
    title: "Planes",
    text: "Half-planes that share a plane form a group. Its border lines, and where it meets other planes, close the facet.",
    question: "Pick a group of at least four lines that became a facet.",
    answer: () => {
      const { lines, facets } = pickedGroup();
      return `${counted(lines, "lines")}, each found on its own, lie in one plane: facet ${facets.map(numberOf).join(", ")} of the model.`;
    },
    hint: () => {
      const { lines, facets } = pickedGroup();
      if (lines === 0) {
        return null;
      }
      return facets.length === 0
        ? `${counted(lines, "lines")}, but no facet: nothing shows that there is a roof in this plane.`
        : `Facet ${facets.map(numberOf).join(", ")}, from ${counted(lines, "lines")}: look for a group with more.`;
    },
    isFound: () => {
      const { lines, facets } = pickedGroup();
      return lines >= 4 && facets.length > 0;
    },
  },
] satisfies readonly StageStep[];

const pickedGroup = () => groupParts(results.value, pickedIndex(selection.value, "group"));

/** The lines of a group, and the facets that it became. */
export function groupParts(
  { grouping, facets }: Pick<Results, "grouping" | "facets">,
  group: number,
): { lines: number; facets: number[] } {
  const found = grouping?.groups[group];
  return found === undefined
    ? { lines: 0, facets: [] }
    : {
        lines: new Set(found.members.map(({ line }) => line)).size,
        facets: (facets ?? []).flatMap((facet, i) => (isMadeFrom(facet, found) ? [i] : [])),
      };
}

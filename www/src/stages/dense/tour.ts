/** The tour: planes without lines. */
import { counted } from "../../app/parts/counted";
import { percentText } from "../../app/parts/numberText";
import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { densePlanesOf } from "../../shared/records";
import { numberOf, pickedIndex } from "../../shared/selection";
import { likeliestClass } from "../../shared/surfaceClass";
import type { Results } from "../list";
import { ofPicked, type StageStep } from "../tourStep";

export default [
  {
    title: "Dense planes",
    text: "Not every roof has a line that starts its plane. So small patches are matched all over the plan, by their texture alone, and those in one plane are joined. They find lawns and trees as well: what is a building follows from height, roughness and colour.",
    question: "Pick a plane that is most probably a building, and that a facet of the model has.",
    ...ofPicked(() => densePlaneParts(results.value, pickedIndex(selection.value, "dense")), {
      answer: (plane) => `${denseWords(plane)} ${halfPlaneWords(plane)}`,
      hint: ({ name, probability }) =>
        name === "building"
          ? "Most probably a building, but no facet of the model has this plane."
          : `Most probably ${name} (${percentText(probability)}): look for another colour.`,
      isFound: ({ name, facets }) => name === "building" && facets.length > 0,
    }),
  },
] satisfies readonly StageStep[];

type DensePlaneParts = NonNullable<ReturnType<typeof densePlaneParts>>;

function denseWords({ patches, rmsM, facets }: DensePlaneParts): string {
  return `${counted(patches, "patches")}, each matched on its own, lie within ${(100 * rmsM).toFixed(0)} cm (RMS) of one plane: that of facet ${facets.map(numberOf).join(", ")}.`;
}

function halfPlaneWords({ halfPlanes }: DensePlaneParts): string {
  return halfPlanes === 0
    ? "No half-plane found it."
    : `From lines, ${counted(halfPlanes, "half-planes")} found it, too: two ways, one plane.`;
}

/** What a plane of dense matching is, the facets that it proposed, and how many half-planes these were made from. */
export function densePlaneParts({ dense, facets }: Pick<Results, "dense" | "facets">, index: number) {
  const plane = dense?.planes[index];
  const proposed = (facets ?? []).flatMap((facet, i) => (densePlanesOf(facet).includes(index) ? [i] : []));
  return plane === undefined
    ? null
    : {
        ...likeliestClass(plane.class),
        patches: plane.patches.length,
        rmsM: plane.rms_m,
        facets: proposed,
        halfPlanes: new Set(proposed.flatMap((i) => facets?.[i]?.half_planes ?? [])).size,
      };
}

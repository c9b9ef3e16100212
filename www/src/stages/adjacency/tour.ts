/** The tour: corners as wholes. */
import { counted } from "../../app/parts/counted";
import { results } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { isVerifiedPlane } from "../../shared/proposed";
import { pickedIndex } from "../../shared/selection";
import type { Results } from "../list";
import { ofPicked, type StageStep } from "../tourStep";

export default [
  {
    title: "Corners as wholes",
    text: "A third partner matched no lines at all, but corners with everything that belongs to them: the edges that meet there and the regions between. What borders what in the images borders it in space too, so that one corner proposes several planes at once.",
    question: "Pick a corner that proposes two planes or more, verified by the photographs.",
    ...ofPicked(() => cornerParts(results.value, pickedIndex(selection.value, "corner")), {
      answer: ({ views, edges, planes }) =>
        `${counted(views, "views")} show it with ${counted(edges, "edges")}. The regions between these lie in ${counted(planes, "planes")}: no line was matched, and no plane sought.`,
      hint: () => "One plane or none: look for a corner where three edges meet.",
      isFound: ({ planes }) => planes > 1,
    }),
  },
] satisfies readonly StageStep[];

/** What a corner in space is, with the planes of its regions that the photographs verify; null where there is none. */
export function cornerParts({ adjacency }: Pick<Results, "adjacency">, index: number) {
  const corner = adjacency?.trace.corners[index];
  const own = adjacency?.planes.filter(
    (plane) => isVerifiedPlane(plane) && plane.regions.some(([proposer]) => proposer === index),
  );
  return corner === undefined
    ? null
    : { views: corner.images.length, edges: corner.edges.length, planes: own?.length ?? 0 };
}

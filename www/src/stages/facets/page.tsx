/** The facets in space. */
import { buildFacets } from "../../viewer/layers/facets";
import { FACET } from "../sample";
import { planOf, type StagePage } from "../stagePage";

export default {
  layers: {
    facets: {
      title: "Facets",
      plan: planOf(
        ({ facets }) => [facets],
        (facets) => buildFacets(facets),
      ),
      pickOrder: 9,
      isMeasured: true,
      isCut: true,
      warm: () => buildFacets([FACET]),
    },
  },
  shows: ["facets"],
  isEmpty: ({ facets }) => facets === null,
} satisfies StagePage;

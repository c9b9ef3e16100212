/** The facets in space. */
import { results } from "../../app/state/results";
import { buildFacets } from "../../viewer/layers/facets";
import { FACET } from "../sample";
import type { StagePage } from "../stagePage";

export default {
  layers: {
    facets: {
      title: "Facets",
      plan: () => {
        const { facets } = results.value;
        return facets && [() => buildFacets(facets), facets];
      },
      pickOrder: 9,
      isMeasured: true,
      isCut: true,
      warm: () => buildFacets([FACET]),
    },
  },
  shows: ["facets"],
  isEmpty: ({ facets }) => facets === null,
} satisfies StagePage;

/** Facets and lines in space are those of other stages. */
import type { StagePage } from "../stagePage";

export default {
  shows: ["facets", "lines"],
  isEmpty: ({ facets }) => facets === null,
} satisfies StagePage;

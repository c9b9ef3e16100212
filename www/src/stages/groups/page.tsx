/** The lines of each group in space. */
import { results } from "../../app/state/results";
import type { GroupingTrace } from "../../shared/records";
import { ENDS, FACET, PLANE } from "../sample";
import type { StagePage } from "../stagePage";
import { buildGroups } from "./groupsLayer";

const GROUPING: GroupingTrace = {
  groups: [{ plane: PLANE, members: [{ line: 0, side: null, half_plane: null }], proposals: [] }],
  plane_lines: [{ segment: { p0: [0, 0, 0], p1: [1, 0, 0] }, views: [] }],
  borders: [],
  cells: 0,
};

export default {
  layers: {
    groups: {
      title: "Groups",
      plan: () => {
        const { lines, grouping, facets } = results.value;
        return (
          lines && grouping && [() => buildGroups(grouping, lines, facets ?? []), grouping, lines, facets]
        );
      },
      pickOrder: 1,
      isMeasured: true,
      warm: () => buildGroups(GROUPING, ENDS, [FACET]),
    },
  },
  shows: ["groups"],
  isEmpty: ({ grouping }) => grouping === null,
} satisfies StagePage;

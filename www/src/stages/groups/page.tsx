/** The lines of each group in space. */
import type { Facet, GroupingTrace } from "../../shared/records";
import { ENDS, FACET, PLANE } from "../sample";
import { planOf, type StagePage } from "../stagePage";
import { buildGroups } from "./groupsLayer";

const GROUPING: GroupingTrace = {
  groups: [{ plane: PLANE, members: [{ line: 0, side: null, half_plane: null }], proposals: [] }],
  plane_lines: [{ segment: { p0: [0, 0, 0], p1: [1, 0, 0] }, views: [] }],
  borders: [],
  cells: 0,
};

const NO_FACETS: readonly Facet[] = [];

export default {
  layers: {
    groups: {
      title: "Groups",
      plan: planOf(({ grouping, lines, facets }) => [grouping, lines, facets ?? NO_FACETS], buildGroups),
      pickOrder: 1,
      isMeasured: true,
      warm: () => buildGroups(GROUPING, ENDS, [FACET]),
    },
  },
  shows: ["groups"],
  isEmpty: ({ grouping }) => grouping === null,
} satisfies StagePage;

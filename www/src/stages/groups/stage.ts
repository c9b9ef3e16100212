import type { GroupingTrace } from "../../shared/records";
import type { Stage } from "../stage";

export const groups = {
  about: "group",
  nothing: { grouping: null as GroupingTrace | null },
  fetch: async (from) => ({ grouping: await from.call("grouping") }),
  sections: { roof: "Grouping and facets" },
} satisfies Stage;

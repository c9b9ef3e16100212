import type { RectangleTrace } from "../../shared/records";
import { fetchFacets } from "../facets/stage";
import type { Stage } from "../stage";

export const rectangles = {
  about: "pair",
  nothing: { rectangles: null as RectangleTrace | null },
  fetch: async (from) => ({ ...(await fetchFacets(from)), rectangles: await from.call("rectangles") }),
  sections: { "objectspace.planes": "Planes" },
} satisfies Stage;

import type { Segmentation } from "../../shared/records";
import { perView, type Stage } from "../stage";

export const regions = {
  about: "region",
  nothing: { regions: [] as Segmentation[] },
  fetch: async (from) => ({
    segments: await perView(from, "segments"),
    regions: (await perView(from, "regions")).filter((found) => found !== null),
  }),
  sections: { "objectspace.oris": "Regions (ORIS)" },
  mainCount: "regions",
} satisfies Stage;

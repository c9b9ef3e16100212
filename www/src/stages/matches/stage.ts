import type { MatchRecord } from "../../shared/records";
import { perView, type Stage } from "../stage";

export const matches = {
  about: "segment",
  nothing: { supports: [] as Float32Array[], matching: null as MatchRecord | null },
  fetch: async (from) => ({
    supports: await perView(from, "matchedSegments"),
    matching: await from.call("matching"),
  }),
  sections: { matching: "Matching" },
} satisfies Stage;

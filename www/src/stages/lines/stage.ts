import type { LineRecord } from "../../shared/records";
import { perView, type ResultSource, type Stage } from "../stage";

export const lines = {
  about: "line",
  nothing: {
    lines: null as Float64Array | null,
    records: [] as LineRecord[],
    stretches: null as Float64Array | null,
  },
  fetch: async (from) => ({
    ...(await fetchLines(from)),
    stretches: await from.call("detectedStretches"),
  }),
  sections: { lines3d: "3D lines" },
} satisfies Stage;

/** The lines as they are now: later stages add some. */
export async function fetchLines(from: ResultSource) {
  return {
    supports: await perView(from, "matchedSegments"),
    lines: await from.call("lines"),
    records: await from.call("lineRecords"),
  };
}

import { perView, type Stage } from "../stage";

export const segments = {
  about: "segment",
  nothing: { segments: [] as Float32Array[], rejected: [] as Float32Array[] },
  fetch: async (from) => ({
    segments: await perView(from, "segments"),
    rejected: await perView(from, "rejectedSegments"),
  }),
  sections: { segments: "Segments" },
  mainCount: "segments",
} satisfies Stage;

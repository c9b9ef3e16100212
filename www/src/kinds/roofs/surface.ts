/** A surface of the model as it is written: a roof, a wall, the ground. */
import type { Kind } from "../parts/kind";
import { numberRow } from "../parts/rows";
import facet from "./facet";

/** Rows of a facet that a surface shows by itself. */
const SHOWN = new Set(["Building", "Area"]);

export default {
  title: ({ surface }) => surface.charAt(0).toUpperCase() + surface.slice(1),
  rows: ({ areaM2, building, facet: index }, about) => [
    ["Area", `${areaM2.toFixed(1)} m²`],
    building !== null && numberRow("Building", building),
    ...(index === null
      ? []
      : [
          numberRow("Facet", index),
          ...facet.rows({ kind: "facet", index }, about).filter((row) => row && !SHOWN.has(row[0])),
        ]),
  ],
  siblings: (_, about) => facet.siblings(null, about),
  shapes: ({ facet: index }, results) =>
    index === null ? [] : facet.shapes({ kind: "facet", index }, results),
  lines: ({ facet: index }, results) =>
    index === null ? [] : facet.lines({ kind: "facet", index }, results),
  facet: (picked) => picked.facet,
} satisfies Kind<"surface">;

/** A footprint of the register that is known beforehand, compared with the model. */
import { FOOTPRINT_WORDS, shiftWords } from "../../app/parts/knownText";
import { percentText } from "../../app/parts/numberText";
import type { Kind } from "../parts/kind";
import { numbered } from "../parts/rows";

export default {
  title: ({ index }, { results: { verification } }) =>
    `Footprint ${verification?.register?.footprints[index]?.name ?? ""}`,
  rows({ index }, { results: { verification } }) {
    const register = verification?.register;
    const found = register?.footprints[index];
    if (register === undefined || found === undefined) {
      return [];
    }
    const [[x0, y0], [x1, y1]] = found.bounds_m;
    return [
      ["Outcome", FOOTPRINT_WORDS[found.verdict]],
      ["Under roofs", percentText(found.roofed)],
      found.shift_m !== undefined && ["From it to the roof", shiftWords(found.shift_m)],
      ["Extent", `${(x1 - x0).toFixed(1)} × ${(y1 - y0).toFixed(1)} m`],
      ["Centre", `${((x0 + x1) / 2).toFixed(1)}, ${((y0 + y1) / 2).toFixed(1)} m`],
      ["File", register.compared.file],
    ];
  },
  siblings: (_, { results: { verification } }) =>
    numbered("footprint", verification?.register?.footprints.length),
} satisfies Kind<"footprint">;

/** A footprint of the register, compared with the model. */
import { FOOTPRINT_WORDS, shiftWords } from "../parts/knownText";
import { percentText } from "../parts/numberText";
import { results } from "../state/results";
import type { Row } from "./rowLinks";

export function footprintRows(index: number): Row[] {
  const register = results.value.verification?.register;
  const found = register?.footprints[index];
  if (register === undefined || found === undefined) {
    return [];
  }
  const [[x0, y0], [x1, y1]] = found.bounds_m;
  return [
    ["Outcome", FOOTPRINT_WORDS[found.verdict]],
    ["Under roofs", percentText(found.roofed)],
    ...(found.shift_m === undefined ? [] : [["From it to the roof", shiftWords(found.shift_m)] as const]),
    ["Extent", `${(x1 - x0).toFixed(1)} × ${(y1 - y0).toFixed(1)} m`],
    ["Centre", `${((x0 + x1) / 2).toFixed(1)}, ${((y0 + y1) / 2).toFixed(1)} m`],
    ["File", register.file],
  ];
}

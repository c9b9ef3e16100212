/** A rejected cluster of a cluster plane (W96 3.5); the selected ones are 3D lines. */
import { degreesOf } from "../../app/parts/numberText";
import type { Vec3 } from "../../shared/records";
import { numberOf, type Picked } from "../../shared/selection";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { allOf } from "../parts/rows";
import { openLine } from "../parts/shapes";

export default {
  title: ({ plane, index }) => `Rejected cluster ${numberOf(index)} of plane ${numberOf(plane)}`,
  rows({ plane, index }, { results }) {
    const trace = results.clusters?.[plane];
    const found = trace?.refused[index];
    if (trace === undefined || found === undefined) {
      return [];
    }
    const [[across, height], gain] = found;
    return [
      ["Across", `${across.toFixed(2)} m`],
      ["Height", `${height.toFixed(2)} m`],
      ["Along", `${degreesOf(trace.azimuth).toFixed(1)}° from X towards Y`],
      ["Gain G", `${gain.toFixed(1)} bit`],
      ["Rejected", gain > 0 ? "better clusters need its image lines" : "it does not shorten the description"],
    ];
  },
  siblings: (picked, { results: { clusters } }) =>
    picked === null ? [] : allOf(clusters?.[picked.plane]?.refused.length, (index) => ({ ...picked, index })),
  shapes: (picked, results) => openLine(ends(picked, results)),
} satisfies Kind<"cluster">;

/** A cluster has no ends: it is drawn as far as any line of its direction reaches. */
function ends({ plane, index }: Picked<"cluster">, { clusters, lines }: Results): Vec3[] {
  const trace = clusters?.[plane];
  const [place] = trace?.refused[index] ?? [];
  if (trace === undefined || place === undefined || lines === null) {
    return [];
  }
  const [c, s] = [Math.cos(trace.azimuth), Math.sin(trace.azimuth)];
  const along = Array.from({ length: lines.length / 3 }, (_, i) => i * 3).map(
    (at) => c * (lines[at] as number) + s * (lines[at + 1] as number),
  );
  const [across, height] = place;
  const at = (t: number): Vec3 => [c * t - s * across, s * t + c * across, height];
  return along.length === 0 ? [] : [at(Math.min(...along)), at(Math.max(...along))];
}

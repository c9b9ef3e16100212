/** What stands on a roof face, in words. */
import type { Obstruction } from "../../shared/records";

/** "0.8 × 0.5 m, 1.2 ± 0.4 m high, 88 %". */
export function obstructionText({ outline, height_m, height_sigma_m, probability }: Obstruction): string {
  const [a = [0, 0], b = [0, 0], c = [0, 0]] = outline;
  const side = (p: readonly number[], q: readonly number[]) =>
    Math.hypot((p[0] ?? 0) - (q[0] ?? 0), (p[1] ?? 0) - (q[1] ?? 0)).toFixed(1);
  const size = outline.length === 4 ? `${side(a, b)} × ${side(b, c)} m, ` : "";
  const sigma = height_sigma_m === null ? "" : ` ± ${height_sigma_m.toFixed(1)}`;
  return `${size}${height_m.toFixed(1)}${sigma} m high, ${Math.round(100 * probability)} %`;
}

/** Where the cameras stood, seen from above, and which of them show the same: the more points two share, the stronger their line. */
import type { OrientationReport } from "../../../../shared/orientation";
import type { Vec3 } from "../../../../shared/records";
import { counted } from "../../../parts/counted";
import { drawnPlan } from "./overlapGeometry";

const SIDE = 260;
const MARGIN = 20;

export function OverlapPlan({ report, centres }: { report: OrientationReport; centres: readonly Vec3[] }) {
  if (centres.length !== report.photos.length) {
    return null;
  }
  const places = drawnPlan(centres, SIDE, MARGIN);
  const most = Math.max(...report.overlap.map(([, , shared]) => shared), 1);
  return (
    <figure class="overlap-plan">
      <svg
        viewBox={`0 0 ${SIDE} ${SIDE}`}
        role="img"
        aria-label={`Plan of ${counted(centres.length, "cameras")}; ${counted(report.overlap.length, "pairs")} of them share points`}
      >
        {report.overlap.map(([a, b, shared]) => {
          const [from, to] = [places[a], places[b]];
          return (
            from !== undefined &&
            to !== undefined && (
              <line
                key={`${a} ${b}`}
                x1={from[0]}
                y1={from[1]}
                x2={to[0]}
                y2={to[1]}
                stroke-opacity={0.15 + (0.85 * shared) / most}
              />
            )
          );
        })}
        {places.map(([x, y], i) => (
          <circle key={report.photos[i]?.file} cx={x} cy={y} r={4}>
            <title>{`${report.photos[i]?.file}: overlaps with ${report.photos[i]?.partners}`}</title>
          </circle>
        ))}
      </svg>
      <figcaption class="muted">
        Overlap, seen from above: the strongest line is a pair that shares {counted(most, "points")}.
      </figcaption>
    </figure>
  );
}

/** Where control points lie, or where photographs were taken, and by how far the block is off there, as arrows. */
import type { OrientationReport } from "../../../../shared/orientation";
import type { Vec3 } from "../../../../shared/records";
import { counted } from "../../../parts/counted";
import { baseName } from "../../inputFiles";
import { drawnPlan, exaggeration } from "./overlapGeometry";
import { planResiduals } from "./residuals";

const SIDE = 260;
const MARGIN = 20;

export function ResidualPlan({ report, centres }: { report: OrientationReport; centres: readonly Vec3[] }) {
  const found = planResiduals(report, centres.length === report.photos.length ? centres : []);
  const offsets = found.map(({ offset }) => offset ?? ([0, 0] as const));
  if (found.length === 0) {
    return null;
  }
  const starts = found.map(({ place: [x, y] }) => [x, y] as const);
  const times = exaggeration(starts, offsets);
  const ends = starts.map(([x, y], i) => {
    const [dx, dy] = offsets[i] ?? [0, 0];
    return [x + times * dx, y + times * dy, 0] as const;
  });
  const drawn = drawnPlan([...starts.map(([x, y]) => [x, y, 0] as const), ...ends], SIDE, MARGIN);
  const what = report.control.length > 0 ? "points" : "photographs";
  const longest = Math.max(...offsets.map(([x, y]) => Math.hypot(x, y)));
  return (
    <figure class="overlap-plan residual-plan" data-testid="residual-plan">
      <svg
        viewBox={`0 0 ${SIDE} ${SIDE}`}
        role="img"
        aria-label={`Plan of ${counted(found.length, what)} with their residuals, at most ${longest.toFixed(2)} m`}
      >
        {found.map(({ name, offset, kind }, i) => {
          const [from, to] = [drawn[i], drawn[found.length + i]];
          return (
            from !== undefined &&
            to !== undefined && (
              <g key={name} class={kind}>
                <title>
                  {`${baseName(name)}: ${offset === null ? "not known in plan" : `${offset.map((d) => d.toFixed(3)).join(", ")} m`}`}
                </title>
                {offset !== null && <path d={arrow(from, to)} />}
                <circle cx={from[0]} cy={from[1]} r={3} />
              </g>
            )
          );
        })}
      </svg>
      <figcaption class="muted">
        By how far the block is from what is stated, in plan, drawn {times} times as long; the longest is{" "}
        {longest.toFixed(2)} m.
      </figcaption>
    </figure>
  );
}

/** Length of an arrow's head. */
const HEAD = 5;

function arrow([x0, y0]: readonly [number, number], [x1, y1]: readonly [number, number]): string {
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (length === 0) {
    return "";
  }
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  const head = Math.min(HEAD, length);
  const side = (by: number) => `${x1 - head * ux - by * head * uy} ${y1 - head * uy + by * head * ux}`;
  return `M${x0} ${y0}L${x1} ${y1}M${side(0.5)}L${x1} ${y1}L${side(-0.5)}`;
}

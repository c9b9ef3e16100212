/** How many photographs show each place of the area, and from where another one would tell most, seen from above. */
import type { CoveredCell, OrientationReport } from "../../../../shared/orientation";
import type { Vec3 } from "../../../../shared/records";
import { counted } from "../../../parts/counted";
import { percentText } from "../../../parts/numberText";
import { baseName } from "../../inputFiles";
import { drawnPlan } from "./overlapGeometry";

const SIDE = 260;
const MARGIN = 20;

/** What a number of photographs is worth, by the classes of the report. */
const CLASSES = [
  { name: "enough", text: "five photographs or more", isOf: (views: number) => views >= 5 },
  { name: "some", text: "three or four", isOf: (views: number) => views >= 3 && views < 5 },
  { name: "few", text: "fewer", isOf: (views: number) => views < 3 },
] as const;

export function CoveragePlan({ report, centres }: { report: OrientationReport; centres: readonly Vec3[] }) {
  const { coverage } = report;
  if (coverage === null || coverage.columns === 0) {
    return null;
  }
  const rows = coverage.cells.length / coverage.columns;
  const [west, south] = coverage.corner;
  const corner: Vec3 = [west, south, 0];
  const opposite: Vec3 = [west + coverage.columns * coverage.side, south + rows * coverage.side, 0];
  const proposed = coverage.proposed.map(({ position }) => position);
  const [from, to, ...places] = drawnPlan([corner, opposite, ...centres, ...proposed], SIDE, MARGIN);
  if (from === undefined || to === undefined) {
    return null;
  }
  const width = (to[0] - from[0]) / coverage.columns;
  const unit = report.is_metric ? "m" : "units";
  return (
    <figure class="overlap-plan coverage-plan" data-testid="coverage-plan">
      <svg
        viewBox={`0 0 ${SIDE} ${SIDE}`}
        role="img"
        aria-label={`Plan of the area: ${report.coverage_words[0] ?? ""}`}
      >
        {coverage.cells.map((cell, i) => {
          const [column, row] = [i % coverage.columns, Math.floor(i / coverage.columns)];
          return (
            cell !== null && (
              <rect
                key={`${column} ${row}`}
                class={CLASSES.find(({ isOf }) => isOf(cell.views))?.name ?? ""}
                x={from[0] + column * width}
                y={from[1] - (row + 1) * width}
                width={width}
                height={width}
              >
                <title>{cellText(cell, unit)}</title>
              </rect>
            )
          );
        })}
        {centres.map((_, i) => (
          <circle key={report.photos[i]?.file} cx={places[i]?.[0]} cy={places[i]?.[1]} r={2} />
        ))}
        {coverage.proposed.map(({ like }, i) => {
          const [x = 0, y = 0] = places[centres.length + i] ?? [];
          return (
            <path key={`${x} ${y}`} d={`M${x} ${y - 7}l6 11h-12z`}>
              <title>{`Another photograph, in the direction of ${baseName(like)}`}</title>
            </path>
          );
        })}
      </svg>
      <figcaption class="muted">
        {CLASSES.map(({ name, text }, i) => (
          <span key={name} class="class">
            <i class={name} /> {text} {percentText(coverage.shares[i] ?? 0)}
          </span>
        ))}
        <span>
          Dots are the cameras{proposed.length > 0 && ", triangles where another photograph would tell most"}.
        </span>
      </figcaption>
    </figure>
  );
}

function cellText({ views, angle_deg, height_sigma }: CoveredCell, unit: string): string {
  const angle = views > 1 ? `, from directions up to ${angle_deg.toFixed(0)}° apart` : "";
  const height =
    height_sigma === null ? "" : `; a height from one pixel each ± ${height_sigma.toPrecision(2)} ${unit}`;
  return `${counted(views, "photographs")}${angle}${height}`;
}

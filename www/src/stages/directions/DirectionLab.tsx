/** W96 3.4: the histogram of azimuths (figures 4 and 5), and which direction an image line follows. */
import { numberOf } from "../../shared/selection";
import "../../app/view/figures/figures.css";
import { axesOf, Chart, closedPathOf, Fit, type Frame } from "../../app/parts/charts";
import { degreesOf } from "../../app/parts/numberText";
import { PlaneChoice } from "../../app/view/figures/PlaneChoice";
import { category } from "../../shared/palette";
import type { MainDirections } from "../../shared/records";
import type { Figure } from "../figure";

const HALF = Math.PI / 2;

/** Figures 4 and 5. The histogram's two perpendicular peaks, found together. */
export function DirectionLab({ figure }: { figure: Figure }) {
  const found = figure.results.directions;
  if (found === null || found.trace.histograms.length === 0) {
    return <p class="lab-hint muted">Run the stage: the histogram of azimuths appears here.</p>;
  }
  const shown = Math.min(figure.plane, found.windows.length - 1);
  const histogram = found.trace.histograms[shown];
  const pairs = found.windows[shown]?.directions ?? [];
  return (
    <div class="chart-lab" data-testid="direction-lab">
      <PlaneChoice
        names={found.windows.map((_, i) => `Building ${numberOf(i)}`)}
        shown={shown}
        onShow={figure.act.showPlane}
      />
      {histogram !== undefined && (
        <Fit>
          {(frame) => (
            <Histogram frame={frame} values={histogram.histogram} binDeg={histogram.bin_deg} pairs={pairs} />
          )}
        </Fit>
      )}
    </div>
  );
}

function Histogram({
  frame,
  values,
  binDeg,
  pairs,
}: {
  frame: Frame;
  values: readonly number[];
  binDeg: number;
  pairs: readonly MainDirections[];
}) {
  const top = Math.max(...values, 1e-9);
  const x = { min: 0, max: 180 };
  const y = { min: 0, max: top };
  const [toX, toY] = axesOf(frame, x, y);
  const outline = values.map((value, i) => [toX((i + 0.5) * binDeg), toY(value)] as const);
  const floor = toY(0);
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="azimuth (degrees from X towards Y)"
      yTitle="weight"
      xTicks={[0, 30, 60, 90, 120, 150, 180]}
      label={`Azimuths of all image lines; main directions at ${pairs
        .map(({ azimuth }) => degreesOf(azimuth).toFixed(1))
        .join(", ")} degrees`}
      testid="histogram"
    >
      <path class="area" d={closedPathOf([[toX(0), floor], ...outline, [toX(180), floor]])} />
      {pairs.slice(0, 1).flatMap(({ azimuth, share }) =>
        [azimuth, azimuth + HALF].map((angle, axis) => {
          const at = toX(degreesOf(angle) % 180);
          return (
            <g key={angle}>
              <line x1={at} x2={at} y1={frame.top} y2={floor} stroke={category(axis)} class="peak" />
              <text x={at + 4} y={frame.top + 10} class="peak-name">
                {(degreesOf(angle) % 180).toFixed(1)}°{axis === 0 && ` · ${Math.round(100 * share)} %`}
              </text>
            </g>
          );
        }),
      )}
    </Chart>
  );
}

/** B99 figure 9: accuracy against the number of views. */
import "../../app/view/figures/figures.css";
import { axesOf, Chart, dotsOf, Fit, type Frame, type Scale } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { Filmstrip } from "../../app/view/images/Filmstrip";
import type { LineRecord } from "../../shared/records";
import { pickedIndex } from "../../shared/selection";
import type { Figure } from "../figure";
import type { Results } from "../list";

/** The 3D lines by number of views, and the picked one in every view. */
export function LineLab({ figure }: { figure: Figure }) {
  return (
    <div class="split-lab">
      <Fit>{(frame) => <Accuracy frame={frame} figure={figure} />}</Fit>
      <Filmstrip figure={figure} />
    </div>
  );
}

/** Standard deviation of each line against the views that support it; the median of each column as a bar. */
function Accuracy({ frame, figure }: { frame: Frame; figure: Figure }) {
  const records = matchedRecords(figure.results);
  const picked = pickedIndex(figure.selection, "line");
  if (records.length === 0) {
    return <p class="lab-hint muted">Run the stage: accuracy against views appears here.</p>;
  }
  const counts = [...new Set(records.map(({ supports }) => supports.length))].sort((a, b) => a - b);
  const x = { min: (counts[0] ?? 3) - 0.6, max: (counts.at(-1) ?? 3) + 0.6 };
  const sigmas = records.map(({ sigma_m }) => 100 * sigma_m);
  const y = { min: 0, max: 1.1 * quantile(sigmas, 0.98) };
  const [toX, toY] = axesOf(frame, x, y);
  const places = records.map(
    ({ supports }, i) =>
      [toX(supports.length + scatter(i)), toY(Math.min(y.max, sigmas[i] as number))] as const,
  );
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="views that support the line"
      yTitle="σ across (cm)"
      xTicks={counts}
      label={`Standard deviation of ${counted(records.length, "lines")} against the number of their views`}
      testid="accuracy"
      onClick={(views, sigma) => {
        const index = nearest(records, views, sigma, x, y);
        figure.act.select({ kind: "line", index });
      }}
    >
      <path class="dot-line" d={dotsOf(places)} data-count={places.length} />
      {counts.map((count) => {
        const own = sigmas.filter((_, i) => records[i]?.supports.length === count);
        const [from, to, median] = [toX(count - 0.34), toX(count + 0.34), toY(quantile(own, 0.5))];
        return <line key={count} class="median" x1={from} x2={to} y1={median} y2={median} />;
      })}
      {places
        .filter((_, i) => i === picked)
        .map(([cx, cy]) => (
          <circle key={cx} class="picked-dot" cx={cx} cy={cy} r={5} />
        ))}
    </Chart>
  );
}

/** The matched lines: new ones come after them. */
function matchedRecords({ records }: Pick<Results, "records">): LineRecord[] {
  return records.filter(({ origin }) => origin === "matched");
}

/** Spreads the dots of a column, the same way every time. */
function scatter(i: number): number {
  return (((i * 0.618034) % 1) - 0.5) * 0.6;
}

function nearest(records: readonly LineRecord[], views: number, sigma: number, x: Scale, y: Scale): number {
  const distance = (i: number) => {
    const { sigma_m = 0, supports = [] } = records[i] ?? {};
    return Math.hypot(
      (supports.length + scatter(i) - views) / (x.max - x.min),
      (100 * sigma_m - sigma) / (y.max - y.min),
    );
  };
  return records.reduce((best, _, i) => (distance(i) < distance(best) ? i : best), 0);
}

export function quantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.round(share * (sorted.length - 1))] ?? 0;
}

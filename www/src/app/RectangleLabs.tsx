/** W96: the histogram of azimuths (figures 4 and 5), the cluster plane (7 and 8), and the window of a plane (10 and 11). */
import { category } from "../shared/palette";
import { LINE_STRIDE } from "../shared/results";
import type { ClusterTrace, MainDirections, PlaneTrace, Vec2 } from "../shared/traces";
import { Chart, Fit, type Frame, pathOf, type Scale, xOf, yOf } from "./charts";
import { Filmstrip } from "./Filmstrip";
import { results, scene, selection, shownPlane } from "./state";
import { PAIR_WORDS } from "./words";

const HALF = Math.PI / 2;

export const degreesOf = (radians: number) => (radians * 180) / Math.PI;

/** Figures 4 and 5. The histogram's two perpendicular peaks, found together. */
export function DirectionLab() {
  const found = results.value.directions;
  if (found === null || found.trace.histograms.length === 0) {
    return <p class="lab-hint muted">Run the stage: the histogram of azimuths appears here.</p>;
  }
  const shown = Math.min(shownPlane.value, found.windows.length - 1);
  const histogram = found.trace.histograms[shown];
  const pairs = found.windows[shown]?.directions ?? [];
  return (
    <div class="chart-lab" data-testid="direction-lab">
      <Choice
        names={found.windows.map((_, i) => `Building ${i}`)}
        shown={shown}
        onShow={(i) => {
          shownPlane.value = i;
        }}
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
  const [toX, toY] = [xOf(frame, x), yOf(frame, y)];
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
      <path class="area" d={`${pathOf([[toX(0), floor], ...outline, [toX(180), floor]])}Z`} />
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

/** The main direction that an image line may follow: its interpretation plane cut with the XY plane (W96 3.4). */
export function directionColours(view: number): (string | null)[] | null {
  const info = scene.value?.views[view];
  const segments = results.value.segments[view];
  const pair = results.value.directions?.windows[shownPlane.value]?.directions[0];
  if (info === undefined || segments === undefined || pair === undefined) {
    return null;
  }
  const p = info.projection;
  const tolerance = (3 * Math.PI) / 180;
  return Array.from({ length: segments.length / 4 }, (_, i) => {
    const [x0, y0, x1, y1] = [0, 1, 2, 3].map((k) => segments[4 * i + k] as number) as [
      number,
      number,
      number,
      number,
    ];
    const line = [y0 - y1, x1 - x0, x0 * y1 - x1 * y0] as const;
    const normal = (column: number) =>
      line.reduce((sum, l, row) => sum + l * (p[4 * row + column] as number), 0);
    const azimuth = Math.atan2(-normal(0), normal(1));
    const off = (angle: number) =>
      Math.abs(((((azimuth - angle) % Math.PI) + 1.5 * Math.PI) % Math.PI) - HALF);
    return off(pair.azimuth) < tolerance
      ? category(0)
      : off(pair.azimuth + HALF) < tolerance
        ? category(1)
        : null;
  });
}

/** Figures 7 and 8: image lines of one direction in the plane across it, and the clusters that description length chose. */
export function ClusterLab() {
  const { clusters } = results.value;
  if (clusters === null || clusters.length === 0) {
    return <p class="lab-hint muted">Run the stage: the cluster planes appear here.</p>;
  }
  const shown = Math.min(shownPlane.value, clusters.length - 1);
  const trace = clusters[shown] as ClusterTrace;
  return (
    <div class="chart-lab" data-testid="cluster-lab">
      <Choice
        names={clusters.map(({ azimuth }, i) => `${i}: ${degreesOf(azimuth).toFixed(0)}°`)}
        shown={shown}
        onShow={(i) => {
          shownPlane.value = i;
        }}
      />
      <Fit>{(frame) => <ClusterPlane frame={frame} trace={trace} />}</Fit>
      <p class="muted numbers note-line">
        {trace.lines.length} image lines, {trace.proposals[0].toLocaleString("en")} intersections,{" "}
        {trace.proposals[1].toLocaleString("en")} looked at, {trace.selected.length} selected
      </p>
    </div>
  );
}

function ClusterPlane({ frame, trace }: { frame: Frame; trace: ClusterTrace }) {
  const [x, y] = rangesOf([...trace.selected, ...trace.refused].map(([at]) => at));
  const [toX, toY] = [xOf(frame, x), yOf(frame, y)];
  const dot = ([across, height]: Vec2) => ({ cx: toX(across), cy: toY(height) });
  const chosen = lineOfSelection();
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="across the main direction (m)"
      yTitle="height (m)"
      label={`Cluster plane: ${trace.lines.length} image lines and ${trace.selected.length} selected clusters`}
      testid="cluster-plane"
      onClick={(across, height) => {
        const line = nearestLine(trace, [across, height], x, y);
        selection.value = line === null ? null : { kind: "line", index: line };
      }}
    >
      <clipPath id="cluster-clip">
        <rect
          x={frame.left}
          y={frame.top}
          width={frame.width - frame.left - frame.right}
          height={frame.height - frame.top - frame.bottom}
        />
      </clipPath>
      <g clip-path="url(#cluster-clip)">
        {trace.lines.map(([view, [a, b]], i) => (
          <path
            key={i}
            class="sight"
            d={pathOf(stretched(a, b).map(([across, height]) => [toX(across), toY(height)] as const))}
            stroke={category(view)}
          />
        ))}
        {trace.refused.map(([at], i) => (
          <circle key={i} class="refused-cluster" {...dot(at)} r={2.5} />
        ))}
        {trace.selected.map(([at, gain], i) => (
          <circle key={i} class="cluster" {...dot(at)} r={5}>
            <title>{`${at[0].toFixed(2)} m across, ${at[1].toFixed(2)} m high, gain ${gain.toFixed(0)} bit`}</title>
          </circle>
        ))}
        {chosen !== null && isAlong(chosen, trace) && (
          <circle class="chosen-cluster" {...dot(placeOf(chosen, trace))} r={8} />
        )}
      </g>
    </Chart>
  );
}

/** A line of the plane, drawn far enough to leave the chart. */
function stretched([ax, ay]: Vec2, [bx, by]: Vec2): [Vec2, Vec2] {
  const far = 50;
  const [dx, dy] = [bx - ax, by - ay];
  return [
    [ax - far * dx, ay - far * dy],
    [bx + far * dx, by + far * dy],
  ];
}

function rangesOf(places: readonly Vec2[]): [Scale, Scale] {
  const range = (values: number[], margin: number): Scale => ({
    min: Math.min(...values, Number.POSITIVE_INFINITY) - margin,
    max: Math.max(...values, Number.NEGATIVE_INFINITY) + margin,
  });
  return places.length === 0
    ? [
        { min: -10, max: 10 },
        { min: 0, max: 10 },
      ]
    : [
        range(
          places.map(([across]) => across),
          2,
        ),
        range(
          places.map(([, height]) => height),
          1.5,
        ),
      ];
}

/** (across, height) of the middle of a 3D line in the plane of a trace. */
function placeOf(line: number, { azimuth }: ClusterTrace): Vec2 {
  const n =
    results.value.lines?.subarray(line * LINE_STRIDE, (line + 1) * LINE_STRIDE) ??
    new Float64Array(LINE_STRIDE);
  const [x, y, z] = [0, 1, 2].map((k) => ((n[k] as number) + (n[k + 3] as number)) / 2) as [
    number,
    number,
    number,
  ];
  return [-Math.sin(azimuth) * x + Math.cos(azimuth) * y, z];
}

function isAlong(line: number, { azimuth }: ClusterTrace): boolean {
  const n = results.value.lines?.subarray(line * LINE_STRIDE, (line + 1) * LINE_STRIDE);
  if (n === undefined) {
    return false;
  }
  const turn = Math.atan2((n[4] as number) - (n[1] as number), (n[3] as number) - (n[0] as number)) - azimuth;
  return Math.abs(Math.sin(turn)) < 0.02;
}

/** The 3D line of this direction nearest to a place of the plane, within reach of a click. */
function nearestLine(trace: ClusterTrace, [across, height]: Vec2, x: Scale, y: Scale): number | null {
  const reach = 0.03;
  let best: { line: number; distance: number } | null = null;
  for (let line = 0; line < (results.value.lines?.length ?? 0) / LINE_STRIDE; line += 1) {
    if (isAlong(line, trace)) {
      const [u, v] = placeOf(line, trace);
      const distance = Math.hypot((u - across) / (x.max - x.min), (v - height) / (y.max - y.min));
      if (distance < (best?.distance ?? reach)) {
        best = { line, distance };
      }
    }
  }
  return best?.line ?? null;
}

function lineOfSelection(): number | null {
  return selection.value?.kind === "line" ? selection.value.index : null;
}

/** Figures 10 and 11: the window between two parallel lines, the lines that cross it, and their positions. */
export function RectangleLab() {
  const found = results.value.rectangles;
  if (found === null || found.pairs.length === 0) {
    return <p class="lab-hint muted">Run the stage: the windows between parallel lines appear here.</p>;
  }
  const shown = shownPair();
  const pair = found.pairs[shown] as PlaneTrace;
  const isChosen = (index: number) =>
    found.chosen.some((k) => samePair(found.candidates[k]?.lines, found.pairs[index]?.lines));
  return (
    <div class="split-lab even">
      <div class="chart-lab" data-testid="rectangle-lab">
        <label class="pair-choice">
          Pair of lines
          <select
            value={shown}
            onChange={(event) => {
              selection.value = { kind: "pair", index: Number(event.currentTarget.value) };
            }}
          >
            {found.pairs.map((one, i) => (
              <option key={one.lines.join()} value={i}>
                {one.lines.join(" and ")}
                {isChosen(i)
                  ? " · selected"
                  : one.rejection === null
                    ? " · candidate"
                    : ` · ${PAIR_WORDS[one.rejection]}`}
              </option>
            ))}
          </select>
        </label>
        <Fit>{(frame) => <PlaneWindow outer={frame} pair={pair} />}</Fit>
      </div>
      <Filmstrip />
    </div>
  );
}

/** The selected pair, or the one of the best plane. */
function shownPair(): number {
  const found = results.value.rectangles;
  const picked = selection.value;
  if (found === null) {
    return 0;
  }
  if (picked?.kind === "pair") {
    return Math.min(picked.index, found.pairs.length - 1);
  }
  const facet = picked?.kind === "facet" ? picked.index : 0;
  const lines = found.candidates[found.chosen[facet] ?? -1]?.lines;
  return Math.max(
    0,
    found.pairs.findIndex((one) => samePair(lines, one.lines)),
  );
}

function samePair(a: readonly number[] | undefined, b: readonly number[] | undefined): boolean {
  return a?.length === 2 && b !== undefined && a.includes(b[0] as number) && a.includes(b[1] as number);
}

function PlaneWindow({ outer, pair }: { outer: Frame; pair: PlaneTrace }) {
  const along = pair.crossings.flatMap(({ at }) => at);
  const width = Math.max(1, ...pair.crossings.flatMap(({ across }) => across));
  const x: Scale =
    along.length === 0
      ? { min: 0, max: 10 }
      : { min: Math.min(...along) - 0.5, max: Math.max(...along) + 0.5 };
  const frame = { ...outer, bottom: 82 };
  const y = { min: 0, max: width };
  const [toX, toY] = [xOf(frame, x), yOf(frame, y)];
  const bins = histogramOf(
    pair.crossings.map(({ at }) => (at[0] + at[1]) / 2),
    x,
    60,
  );
  const top = Math.max(...bins, 1);
  const base = outer.height - outer.bottom;
  const step = (outer.width - outer.left - outer.right) / bins.length;
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="along the lines (m); below: histogram of positions"
      yTitle="across (m)"
      xTicks={[]}
      label={`${pair.crossings.length} image lines cross the window, ${pair.ends.length} ends were found`}
      testid="plane-window"
    >
      {pair.crossings.map(({ view, at, across, contrast }, i) => (
        <line
          key={i}
          class="crossing"
          x1={toX(at[0] + ((at[1] - at[0]) * across[0]) / width)}
          x2={toX(at[0] + ((at[1] - at[0]) * across[1]) / width)}
          y1={toY(across[0])}
          y2={toY(across[1])}
          stroke={category(view)}
          opacity={0.35 + 0.65 * Math.min(1, 5 * contrast)}
        />
      ))}
      {pair.ends.map(({ at, support }) => (
        <line
          key={at.join()}
          class="end"
          x1={toX(at[0])}
          x2={toX(at[1])}
          y1={toY(0)}
          y2={toY(width)}
          opacity={0.4 + 0.6 * support}
        />
      ))}
      {bins.map((count, i) => (
        <rect
          key={i}
          class="bin"
          x={outer.left + i * step}
          width={Math.max(1, step - 1)}
          y={base - (44 * count) / top}
          height={(44 * count) / top}
        />
      ))}
      {pair.ends.map(({ at }) => (
        <path key={at.join()} class="end-mark" d={`M${toX((at[0] + at[1]) / 2)} ${base + 2}l-5 8h10z`} />
      ))}
    </Chart>
  );
}

export function histogramOf(values: readonly number[], { min, max }: Scale, count: number): number[] {
  const bins = new Array<number>(count).fill(0);
  for (const value of values) {
    const bin = Math.min(count - 1, Math.floor(((value - min) / (max - min)) * count));
    if (bin >= 0) {
      bins[bin] = (bins[bin] as number) + 1;
    }
  }
  return bins;
}

function Choice({
  names,
  shown,
  onShow,
}: {
  names: readonly string[];
  shown: number;
  onShow: (i: number) => void;
}) {
  if (names.length > 7) {
    return (
      <label class="pair-choice">
        Plane
        <select value={shown} onChange={(event) => onShow(Number(event.currentTarget.value))}>
          {names.map((name, i) => (
            <option key={name} value={i}>
              {name}
            </option>
          ))}
        </select>
      </label>
    );
  }
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">Plane</legend>
      {names.map((name, i) => (
        <button key={name} type="button" aria-pressed={shown === i} onClick={() => onShow(i)}>
          {name}
        </button>
      ))}
    </fieldset>
  );
}

/** W96 3.5: the plane across a main direction, its image lines and its clusters (figures 7 and 8). */
import "../../app/view/figures/figures.css";
import { useId } from "preact/hooks";
import { axesOf, Chart, Fit, type Frame, pathOf, type Scale } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { degreesOf, grouped } from "../../app/parts/numberText";
import { PlaneChoice } from "../../app/view/figures/PlaneChoice";
import { LINE_STRIDE } from "../../shared/flatArrays";
import { category } from "../../shared/palette";
import type { ClusterTrace, Directions, Vec2 } from "../../shared/records";
import { numberOf, pickedIndex, type Selection } from "../../shared/selection";
import type { Figure } from "../figure";
import type { Results } from "../list";

/** Figures 7 and 8: image lines of one direction in the plane across it, and the clusters that description length chose. */
export function ClusterLab({ figure }: { figure: Figure }) {
  const { clusters, directions } = figure.results;
  if (clusters === null || clusters.length === 0) {
    return <p class="lab-hint muted">Run the stage: the cluster planes appear here.</p>;
  }
  const shown = Math.min(figure.plane, clusters.length - 1);
  const trace = clusters[shown] as ClusterTrace;
  return (
    <div class="chart-lab" data-testid="cluster-lab">
      <PlaneChoice names={planeNames(clusters, directions)} shown={shown} onShow={figure.act.showPlane} />
      <Fit>{(frame) => <ClusterPlane frame={frame} figure={figure} plane={shown} trace={trace} />}</Fit>
      <p class="muted numbers note-line">
        {counted(trace.lines.length, "image lines")}, {counted(trace.proposals[0], "intersections")},{" "}
        {grouped(trace.proposals[1])} evaluated, {grouped(trace.selected.length)} selected
      </p>
    </div>
  );
}

/** Each plane by its building and the direction that it is across: a building has two. */
export function planeNames(
  clusters: readonly Pick<ClusterTrace, "azimuth">[],
  directions: Pick<Directions, "windows"> | null,
): string[] {
  const buildings = (directions?.windows ?? []).flatMap((window, i) =>
    window.directions.flatMap(() => [numberOf(i), numberOf(i)]),
  );
  return clusters.map(({ azimuth }, i) => {
    const along = `along ${degreesOf(azimuth).toFixed(0)}°`;
    return buildings.length === clusters.length ? `Building ${buildings[i]}, ${along}` : `Lines ${along}`;
  });
}

interface PlaneProps {
  frame: Frame;
  figure: Figure;
  plane: number;
  trace: ClusterTrace;
}

function ClusterPlane({ frame, figure, plane, trace }: PlaneProps) {
  const { lines } = figure.results;
  const clip = useId();
  const [x, y] = rangesOf([...trace.selected, ...trace.refused].map(([at]) => at));
  const [toX, toY] = axesOf(frame, x, y);
  const dot = ([across, height]: Vec2) => ({ cx: toX(across), cy: toY(height) });
  const chosen = placeOfSelection(figure, plane, trace);
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="across the main direction (m)"
      yTitle="height (m)"
      label={`Cluster plane: ${counted(trace.lines.length, "image lines")} and ${counted(trace.selected.length, "selected clusters")}`}
      testid="cluster-plane"
      onClick={(across, height) => {
        const distance = ([u, v]: Vec2) =>
          Math.hypot((u - across) / (x.max - x.min), (v - height) / (y.max - y.min));
        figure.act.select(
          nearest(
            [...linesOf(lines, trace), ...rejectedOf(plane, trace)],
            ([one, at]) => distance(at) - (one.kind === "line" ? RING : 0),
          ),
        );
      }}
    >
      <clipPath id={clip}>
        <rect
          x={frame.left}
          y={frame.top}
          width={frame.width - frame.left - frame.right}
          height={frame.height - frame.top - frame.bottom}
        />
      </clipPath>
      <g clip-path={`url(#${clip})`}>
        {trace.lines.map(([view, [a, b]], i) => (
          <path
            key={i}
            class="sight"
            d={pathOf(stretched(a, b).map(([across, height]) => [toX(across), toY(height)] as const))}
            stroke={category(view)}
          />
        ))}
        {trace.refused.map(([at], i) => (
          <circle key={i} class="rejected-cluster" {...dot(at)} r={2.5} />
        ))}
        {trace.selected.map(([at, gain], i) => (
          <circle key={i} class="cluster" {...dot(at)} r={5}>
            <title>{`${at[0].toFixed(2)} m across, ${at[1].toFixed(2)} m high, gain ${gain.toFixed(0)} bit`}</title>
          </circle>
        ))}
        {chosen !== null && <circle class="chosen-cluster" {...dot(chosen)} r={8} />}
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

type Lines = Results["lines"];

/** (across, height) of the middle of a 3D line in the plane of a trace. */
function placeOf(lines: Lines, line: number, { azimuth }: ClusterTrace): Vec2 {
  const n = lines?.subarray(line * LINE_STRIDE, (line + 1) * LINE_STRIDE) ?? new Float64Array(LINE_STRIDE);
  const [x, y, z] = [0, 1, 2].map((k) => ((n[k] as number) + (n[k + 3] as number)) / 2) as [
    number,
    number,
    number,
  ];
  return [-Math.sin(azimuth) * x + Math.cos(azimuth) * y, z];
}

function isAlong(lines: Lines, line: number, { azimuth }: ClusterTrace): boolean {
  const n = lines?.subarray(line * LINE_STRIDE, (line + 1) * LINE_STRIDE);
  if (n === undefined) {
    return false;
  }
  const turn = Math.atan2((n[4] as number) - (n[1] as number), (n[3] as number) - (n[0] as number)) - azimuth;
  return Math.abs(Math.sin(turn)) < 0.02;
}

/** Share of the chart's sides within which a click finds something. */
const REACH = 0.03;
/** So much of it a selected cluster's ring takes up: inside, the ring is meant, and not what was rejected for its sake. */
const RING = 0.012;

/** The 3D lines of this direction and where they lie in the plane. */
function linesOf(lines: Lines, trace: ClusterTrace): Place[] {
  const all = Array.from({ length: (lines?.length ?? 0) / LINE_STRIDE }, (_, line) => line);
  return all
    .filter((line) => isAlong(lines, line, trace))
    .map((index): Place => [{ kind: "line", index }, placeOf(lines, index, trace)]);
}

function rejectedOf(plane: number, trace: ClusterTrace): Place[] {
  return trace.refused.map(([at], index): Place => [{ kind: "cluster", plane, index }, at]);
}

type Place = readonly [Selection, Vec2];

function nearest(places: readonly Place[], distance: (place: Place) => number): Selection | null {
  let best: Selection | null = null;
  let least = REACH;
  for (const place of places) {
    const away = distance(place);
    if (away < least) {
      best = place[0];
      least = away;
    }
  }
  return best;
}

/** Where the selected thing lies in this plane; null where it does not. */
function placeOfSelection(
  { selection: picked, results: { lines } }: Figure,
  plane: number,
  trace: ClusterTrace,
): Vec2 | null {
  const line = pickedIndex(picked, "line");
  if (line >= 0 && isAlong(lines, line, trace)) {
    return placeOf(lines, line, trace);
  }
  return picked?.kind === "cluster" && picked.plane === plane
    ? (trace.refused[picked.index]?.[0] ?? null)
    : null;
}

/** W96 3.5: the plane across a main direction, its image lines and its clusters (figures 7 and 8). */
import "../../app/view/figures/figures.css";
import { useId } from "preact/hooks";
import { axesOf, Chart, Fit, type Frame, pathOf, type Scale } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { degreesOf, grouped } from "../../app/parts/numberText";
import { PlaneChoice } from "../../app/view/figures/PlaneChoice";
import { LINE_STRIDE, lineAt } from "../../shared/flatArrays";
import { boundsOf, mix3, nearestOf, sub } from "../../shared/linear";
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
        const found = nearestOf(
          [...linesOf(lines, trace), ...rejectedOf(plane, trace)],
          ([one, at]) => distance(at) - (one.kind === "line" ? RING : 0),
          REACH,
        );
        figure.act.select(found?.[0] ?? null);
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
  const [x0, y0, x1, y1] = places.length === 0 ? [-8, 1.5, 8, 8.5] : boundsOf(places);
  return [
    { min: x0 - 2, max: x1 + 2 },
    { min: y0 - 1.5, max: y1 + 1.5 },
  ];
}

type Lines = Results["lines"];

/** (across, height) of the middle of a 3D line in the plane of a trace; null where it does not run across this plane. */
function placeOf(lines: Lines, line: number, { azimuth }: ClusterTrace): Vec2 | null {
  const ends = lineAt(lines, line);
  if (ends === null) {
    return null;
  }
  const [dx, dy] = sub(ends[1], ends[0]);
  const [x, y, z] = mix3(...ends, 0.5);
  const isAlong = Math.abs(Math.sin(Math.atan2(dy, dx) - azimuth)) < 0.02;
  return isAlong ? [-Math.sin(azimuth) * x + Math.cos(azimuth) * y, z] : null;
}

/** Share of the chart's sides within which a click finds something. */
const REACH = 0.03;
/** So much of it a selected cluster's ring takes up: inside, the ring is meant, and not what was rejected for its sake. */
const RING = 0.012;

/** The 3D lines of this direction and where they lie in the plane. */
function linesOf(lines: Lines, trace: ClusterTrace): Place[] {
  const all = Array.from({ length: (lines?.length ?? 0) / LINE_STRIDE }, (_, line) => line);
  return all.flatMap((index): Place[] => {
    const place = placeOf(lines, index, trace);
    return place === null ? [] : [[{ kind: "line", index }, place]];
  });
}

function rejectedOf(plane: number, trace: ClusterTrace): Place[] {
  return trace.refused.map(([at], index): Place => [{ kind: "cluster", plane, index }, at]);
}

type Place = readonly [Selection, Vec2];

/** Where the selected thing lies in this plane; null where it does not. */
function placeOfSelection(
  { selection: picked, results: { lines } }: Figure,
  plane: number,
  trace: ClusterTrace,
): Vec2 | null {
  return picked?.kind === "cluster" && picked.plane === plane
    ? (trace.refused[picked.index]?.[0] ?? null)
    : placeOf(lines, pickedIndex(picked, "line"), trace);
}

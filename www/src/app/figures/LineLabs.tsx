/** B99 figure 9: accuracy against the number of views; figures 17 to 23: groups and border lines in plan. */
import "./figures.css";
import { category } from "../../shared/palette";
import type { FacetTrace, LineRecord, Vec2, Vec3 } from "../../shared/records";
import { Filmstrip } from "../images/Filmstrip";
import { axesOf, Chart, dotsOf, Fit, type Frame, pathOf, type Scale } from "../parts/charts";
import { counted } from "../parts/counted";
import { facetRejectionWords } from "../parts/reasonText";
import { results } from "../state/results";
import { select, selection } from "../state/viewState";

/** The 3D lines by number of views, and the picked one in every view. */
export function LineLab() {
  return (
    <div class="split-lab">
      <Fit>{(frame) => <Accuracy frame={frame} />}</Fit>
      <Filmstrip />
    </div>
  );
}

/** Standard deviation of each line against the views that support it; the median of each column as a bar. */
function Accuracy({ frame }: { frame: Frame }) {
  const records = matchedRecords();
  if (records.length === 0) {
    return <p class="lab-hint muted">Run the stage: accuracy against views appears here.</p>;
  }
  const counts = [...new Set(records.map(({ supports }) => supports.length))].sort((a, b) => a - b);
  const x = { min: (counts[0] ?? 3) - 0.6, max: (counts.at(-1) ?? 3) + 0.6 };
  const y = {
    min: 0,
    max:
      1.1 *
      quantile(
        records.map(({ sigma_m }) => 100 * sigma_m),
        0.98,
      ),
  };
  const [toX, toY] = axesOf(frame, x, y);
  const places = records.map(
    ({ sigma_m, supports }, i) =>
      [toX(supports.length + scatter(i)), toY(Math.min(y.max, 100 * sigma_m))] as const,
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
        const index = nearest(views, sigma, x, y);
        select({ kind: "line", index });
      }}
    >
      <path class="dot-line" d={dotsOf(places)} data-count={places.length} />
      {counts.map((count) => {
        const own = records
          .filter(({ supports }) => supports.length === count)
          .map(({ sigma_m }) => 100 * sigma_m);
        const median = toY(quantile(own, 0.5));
        return (
          <line
            key={count}
            class="median"
            x1={toX(count - 0.34)}
            x2={toX(count + 0.34)}
            y1={median}
            y2={median}
          />
        );
      })}
      {places
        .filter((_, i) => isPicked(i))
        .map(([cx, cy]) => (
          <circle key={cx} class="picked-dot" cx={cx} cy={cy} r={5} />
        ))}
    </Chart>
  );
}

/** The matched lines: new ones come after them. */
function matchedRecords(): LineRecord[] {
  return results.value.records.filter(({ origin }) => origin === "matched");
}

function isPicked(line: number): boolean {
  return selection.value?.kind === "line" && selection.value.index === line;
}

/** Spreads the dots of a column, the same way every time. */
function scatter(i: number): number {
  return (((i * 0.618034) % 1) - 0.5) * 0.6;
}

function nearest(views: number, sigma: number, x: Scale, y: Scale): number {
  const records = matchedRecords();
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

/** Figures 17 to 20: the groups, largest first. */
export function GroupLab() {
  const { grouping } = results.value;
  if (grouping === null) {
    return (
      <p class="lab-hint muted">Run the facets stage: its groups of coplanar half-planes appear here.</p>
    );
  }
  const order = grouping.groups
    .map((group, index) => ({ group, index }))
    .sort((a, b) => b.group.members.length - a.group.members.length);
  return (
    <div class="split-lab even">
      <ol class="groups" data-testid="groups">
        {order.map(({ group, index }) => {
          const isChosen = selection.value?.kind === "group" && selection.value.index === index;
          const fans = group.members.filter(({ half_plane }) => half_plane !== null).length;
          const [nx, ny, nz] = group.plane.normal;
          return (
            <li key={index}>
              <button
                type="button"
                class="quiet"
                aria-pressed={isChosen}
                onClick={() => {
                  select({ kind: "group", index });
                }}
              >
                <span class="dot" style={{ background: category(index) }} aria-hidden="true" />
                <span>Group {index}</span>
                <span class="muted numbers">
                  {counted(new Set(group.members.map(({ line }) => line)).size, "lines")} ·{" "}
                  {counted(fans, "half-planes")} ·{" "}
                  {group.rectangles?.length ? `${counted(group.rectangles.length, "rectangles")} · ` : ""}
                  {((Math.atan2(Math.hypot(nx, ny), Math.abs(nz)) * 180) / Math.PI).toFixed(0)}°
                </span>
              </button>
            </li>
          );
        })}
      </ol>
      <Filmstrip />
    </div>
  );
}

/** Figures 21 to 23: border lines by their kind, what they enclose, and what was rejected. */
export function FacetLab() {
  const { grouping, facets } = results.value;
  if (grouping === null || facets === null) {
    return <p class="lab-hint muted">Run the stage: the border lines in plan appear here.</p>;
  }
  return (
    <div class="split-lab even">
      <figure class="plan">
        <Fit>
          {(frame) => <Plan frame={frame} grouping={grouping} outlines={facets.map(({ outer }) => outer)} />}
        </Fit>
        <figcaption class="muted numbers">
          <ul class="legend">
            {BORDER_KINDS.map((kind) => (
              <li key={kind}>
                <span class={`swatch border-${kind}`} aria-hidden="true" />
                {BORDER_WORDS[kind]} {grouping.borders.filter((border) => border.kind === kind).length}
              </li>
            ))}
            <li>
              <span class="swatch rejected" aria-hidden="true" />
              rejected {grouping.rejected.length}
            </li>
          </ul>
        </figcaption>
      </figure>
      <Filmstrip />
    </div>
  );
}

const BORDER_KINDS = ["real", "inplane", "intersection", "closing", "rectangle"] as const;
const BORDER_WORDS = {
  real: "3D lines",
  inplane: "new lines",
  intersection: "intersections",
  closing: "closing lines",
  rectangle: "sides of rectangles",
};

/** In SVG the attribute has no capital. */
const FOCUSABLE = { tabindex: 0 };

function Plan({
  frame,
  grouping,
  outlines,
}: {
  frame: Frame;
  grouping: FacetTrace;
  outlines: readonly (readonly Vec3[])[];
}) {
  const points: Vec2[] = [
    ...grouping.borders.flatMap(({ a, b }) => [a, b]),
    ...outlines.flat().map(([x, y]): Vec2 => [x, y]),
  ];
  const xs = points.map(([x]) => x);
  const ys = points.map(([, y]) => y);
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const scale = Math.min(frame.width / (x1 - x0 || 1), frame.height / (y1 - y0 || 1)) * 0.96;
  const at = ([x, y]: readonly number[]): [number, number] => [
    frame.width / 2 + ((x as number) - (x0 + x1) / 2) * scale,
    frame.height / 2 - ((y as number) - (y0 + y1) / 2) * scale,
  ];
  return (
    // biome-ignore lint/a11y/useSemanticElements: SVG has no fieldset
    <svg
      class="chart plan-chart"
      viewBox={`0 0 ${frame.width} ${frame.height}`}
      role="group"
      aria-label={`Plan: ${counted(grouping.borders.length, "border lines")}, ${counted(grouping.cells, "cells")}, ${counted(outlines.length, "facets")}; ${grouping.rejected.length} rejected`}
      data-testid="plan"
    >
      {outlines.map((ring, i) => (
        <PlanArea
          key={i}
          picks={{ kind: "facet", index: i }}
          name={`Facet ${i}`}
          className="plan-facet"
          d={`${pathOf(ring.map(at))}Z`}
        />
      ))}
      {grouping.rejected.map(({ outline, reason }, i) => (
        <PlanArea
          key={i}
          picks={{ kind: "rejectedFacet", index: i }}
          name={`Rejected: ${facetRejectionWords(reason)}`}
          className="plan-rejected"
          d={`${pathOf(outline.map(at))}Z`}
        />
      ))}
      {BORDER_KINDS.map((kind) => {
        const own = grouping.borders.filter((border) => border.kind === kind);
        const path = own.map(({ a, b }) => pathOf([at(a), at(b)])).join("");
        return <path key={kind} class={`border-${kind}`} d={path} data-count={own.length} />;
      })}
    </svg>
  );
}

/** An outline that can be picked, by key as well. */
function PlanArea(of: {
  picks: { kind: "facet" | "rejectedFacet"; index: number };
  name: string;
  className: string;
  d: string;
}) {
  const { kind, index } = of.picks;
  const picked = selection.value;
  const isChosen = picked?.kind === kind && picked.index === index;
  const pick = () => {
    select(of.picks);
  };
  return (
    // biome-ignore lint/a11y/useSemanticElements: SVG has no button
    <path
      role="button"
      {...FOCUSABLE}
      aria-label={of.name}
      aria-pressed={isChosen}
      class={`${of.className} ${isChosen ? "chosen" : ""}`}
      d={of.d}
      onClick={pick}
      onKeyDown={(event) => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          pick();
        }
      }}
    >
      <title>{of.name}</title>
    </path>
  );
}

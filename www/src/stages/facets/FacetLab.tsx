/** B99 figures 21 to 23: the facets in plan, each in the colour of its plane, and the border lines that enclose them. */
import { numberOf } from "../../shared/selection";
import "../../app/view/figures/figures.css";
import { buttonShape, closedPathOf, Fit, type Frame, pathOf } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { FOOTPRINT_WORDS } from "../../app/parts/knownText";
import { facetRejectionWords } from "../../app/parts/reasonText";
import { Filmstrip } from "../../app/view/images/Filmstrip";
import { boundsOf, rectangle } from "../../shared/linear";
import type { Facet, FacetTrace, GroupingTrace, Vec2 } from "../../shared/records";
import { isOfRoof, middleOf } from "../../viewer/scene/facetPlan";
import { roofTintHex } from "../../viewer/scene/roofTint";
import type { Figure } from "../figure";

/** Figures 21 to 23: border lines by their kind, what they enclose, and what was rejected. */
export function FacetLab({ figure }: { figure: Figure }) {
  const { grouping, verification, facets } = figure.results;
  if (grouping === null || verification === null || facets === null) {
    return <p class="lab-hint muted">Run the stage: the border lines in plan appear here.</p>;
  }
  return (
    <div class="split-lab even">
      <figure class="plan">
        <Fit>{(frame) => <Plan {...{ frame, figure, grouping, verification, facets }} />}</Fit>
        <figcaption class="muted numbers">
          <ul class="legend">
            {BORDER_KINDS.map((kind) => [kind, countOf(kind, grouping)] as const)
              .filter(([, count]) => count > 0)
              .map(([kind, count]) => (
                <li key={kind}>
                  <span class={`swatch border-${kind}`} aria-hidden="true" />
                  {BORDER_WORDS[kind]} {count}
                </li>
              ))}
            <li>
              <span class="swatch rejected" aria-hidden="true" />
              rejected {verification.rejected.length}
            </li>
            {verification.register !== undefined && (
              <li title="their bounding boxes">
                <span class="swatch footprint" aria-hidden="true" />
                footprints {verification.register.footprints.length}
              </li>
            )}
          </ul>
        </figcaption>
      </figure>
      <Filmstrip figure={figure} />
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

function countOf(kind: (typeof BORDER_KINDS)[number], { borders }: GroupingTrace): number {
  return borders.filter((border) => border.kind === kind).length;
}

interface PlanProps {
  frame: Frame;
  figure: Figure;
  grouping: GroupingTrace;
  verification: FacetTrace;
  facets: readonly Facet[];
}

function Plan({ frame, figure, grouping, verification, facets }: PlanProps) {
  const outlines = facets.map(({ outer }) => outer);
  // The roofs, and the footprints that are known, fill the figure; border lines on the ground reach far beyond them.
  const footprints = verification.register?.footprints ?? [];
  const points: readonly (readonly number[])[] = [
    ...(outlines.length > 0 ? outlines.flat() : grouping.borders.flatMap(({ a, b }): Vec2[] => [a, b])),
    ...footprints.flatMap(({ bounds_m }) => bounds_m),
  ];
  const [x0, y0, x1, y1] = boundsOf(points);
  const scale = Math.min(frame.width / (x1 - x0 || 1), frame.height / (y1 - y0 || 1)) * 0.9;
  const at = ([x, y]: readonly number[]): [number, number] => [
    frame.width / 2 + ((x as number) - (x0 + x1) / 2) * scale,
    frame.height / 2 - ((y as number) - (y0 + y1) / 2) * scale,
  ];
  const areas: readonly Omit<AreaProps, "figure">[] = [
    ...facets.map((facet, index) => ({
      picks: { kind: "facet", index } as const,
      name: `Facet ${numberOf(index)}`,
      className: "plan-facet",
      fill: roofTintHex(facet),
      d: closedPathOf(facet.outer.map(at)),
    })),
    ...verification.rejected.map(({ outline, reason }, index) => ({
      picks: { kind: "rejectedFacet", index } as const,
      name: `Rejected: ${facetRejectionWords(reason)}`,
      className: "plan-rejected",
      d: closedPathOf(outline.map(at)),
    })),
    ...footprints.map(({ name, verdict, bounds_m }, index) => ({
      picks: { kind: "footprint", index } as const,
      name: `Footprint ${name}: ${FOOTPRINT_WORDS[verdict]}`,
      className: `plan-footprint ${verdict}`,
      d: closedPathOf(rectangle(...bounds_m).map(at)),
    })),
  ];
  return (
    // biome-ignore lint/a11y/useSemanticElements: SVG has no fieldset
    <svg
      class="chart plan-chart"
      viewBox={`0 0 ${frame.width} ${frame.height}`}
      role="group"
      aria-label={`Plan: ${counted(grouping.borders.length, "border lines")}, ${counted(grouping.cells, "cells")}, ${counted(outlines.length, "facets")}; ${verification.rejected.length} rejected`}
      data-testid="plan"
    >
      {areas.map((area) => (
        <PlanArea key={`${area.picks.kind} ${area.picks.index}`} figure={figure} {...area} />
      ))}
      {BORDER_KINDS.map((kind) => {
        const own = grouping.borders.filter((border) => border.kind === kind);
        const pathFor = (borders: typeof own) => borders.map(({ a, b }) => pathOf([at(a), at(b)])).join("");
        const roof = own.filter((border) => isOfRoof(border, outlines));
        const ground = own.filter((border) => !roof.includes(border));
        return (
          <g key={kind}>
            <path class={`border-${kind} ground`} d={pathFor(ground)} />
            <path class={`border-${kind}`} d={pathFor(roof)} data-count={own.length} />
          </g>
        );
      })}
      {outlines.map((ring, i) => {
        const [x, y] = at(middleOf(ring));
        return (
          <text key={i} class="plan-name" x={x} y={y + 4} text-anchor="middle">
            {numberOf(i)}
          </text>
        );
      })}
    </svg>
  );
}

interface AreaProps {
  figure: Figure;
  picks: { kind: "facet" | "rejectedFacet" | "footprint"; index: number };
  name: string;
  className: string;
  fill?: string;
  d: string;
}

/** An outline that can be picked, by key as well. */
function PlanArea(of: AreaProps) {
  const { kind, index } = of.picks;
  const picked = of.figure.selection;
  const isChosen = picked?.kind === kind && picked.index === index;
  return (
    <path
      {...buttonShape(of.name, isChosen, () => of.figure.act.select(of.picks))}
      class={`${of.className} ${isChosen ? "chosen" : ""}`}
      d={of.d}
      style={isChosen || of.fill === undefined ? undefined : { fill: of.fill }}
    >
      <title>{of.name}</title>
    </path>
  );
}

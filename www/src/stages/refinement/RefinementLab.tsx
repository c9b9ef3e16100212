/** B99 2: what refinement made of a building, and the relations that were tested there, each by its chi-square. */
import "../../app/view/figures/figures.css";
import { ListChoice } from "../../app/parts/Choice";
import { axesOf, buttonShape, Chart, Fit, type Frame } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { RELATION_WORDS, refinementWords } from "../../app/parts/reasonText";
import { SplitLab } from "../../app/view/figures/SplitLab";
import { buildingOfFacet, relationLimit } from "../../kinds/parts/refinedBuildings";
import { clamp } from "../../shared/linear";
import type { BuildingRefinement, TestedRelation } from "../../shared/records";
import { numberOf, pickedIndex } from "../../shared/selection";
import type { Figure } from "../figure";

const KINDS = ["horizontal", "parallel", "perpendicular", "equal_height", "symmetric"] as const;
/** The axis is the logarithm of chi-square, between these. */
const LEAST = -3;
const MOST = 3;
/** Room for the names of the kinds. */
const NAMES_PX = 96;

export function RefinementLab({ figure }: { figure: Figure }) {
  const buildings = figure.results.refinement?.buildings ?? [];
  const building = shownBuilding(figure);
  const shown = buildings[building];
  if (shown === undefined) {
    return <p class="lab-hint muted">Run the stage: what refinement tested appears here.</p>;
  }
  return (
    <SplitLab figure={figure} testid="refinement-lab">
      <ListChoice
        title="Building"
        names={buildings.map((one, i) => `${numberOf(i)} · ${refinementWords(one)}`)}
        shown={building}
        onShow={(index) => figure.act.select({ kind: "refinement", index })}
      />
      <Fit>{(frame) => <Relations outer={frame} figure={figure} building={building} of={shown} />}</Fit>
    </SplitLab>
  );
}

/** The building of the selection, or the one with the most relations. */
function shownBuilding({ results, selection: picked }: Figure): number {
  const { buildings = [] } = results.refinement ?? {};
  const own =
    picked?.kind === "facet"
      ? (buildingOfFacet(picked.index, results) ?? 0)
      : picked?.kind === "relation"
        ? picked.building
        : pickedIndex(picked, "refinement");
  return own >= 0
    ? Math.min(own, buildings.length - 1)
    : buildings.reduce(
        (best, { relations }, i) => (relations.length > (buildings[best]?.relations.length ?? 0) ? i : best),
        0,
      );
}

interface RelationsProps {
  outer: Frame;
  figure: Figure;
  building: number;
  of: BuildingRefinement;
}

/** A row for each kind of relation; left of the dashed line is adopted. */
function Relations({ outer, figure, building, of }: RelationsProps) {
  const frame = { ...outer, left: NAMES_PX };
  const x = { min: LEAST, max: MOST };
  const y = { min: 0.5, max: KINDS.length + 0.5 };
  const [toX, toY, upright, level] = axesOf(frame, x, y);
  const row = (kind: TestedRelation["kind"]) => KINDS.length - KINDS.indexOf(kind);
  const limit = relationLimit(figure.params);
  const picked = figure.selection;
  if (of.relations.length === 0) {
    return <p class="lab-hint muted">No relation was near enough to be tested here.</p>;
  }
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="log₁₀ χ²"
      yTitle=""
      yTicks={[]}
      label={`${counted(of.relations.length, "tested relations")} by chi-square, ${of.relations.filter(({ adopted }) => adopted).length} adopted`}
      interactive
      testid="relations"
    >
      {KINDS.map((kind) => (
        <g key={kind}>
          <line class="grid" {...level(row(kind))} />
          <text x={frame.left - 8} y={toY(row(kind)) + 3.5} text-anchor="end">
            {RELATION_WORDS[kind]}
          </text>
        </g>
      ))}
      {limit !== null && <line class="threshold" {...upright(Math.log10(limit))} />}
      {of.relations.map(({ kind, chi2, adopted }, index) => {
        const isPicked =
          picked?.kind === "relation" && picked.building === building && picked.index === index;
        const outcome = adopted ? "adopted" : "rejected";
        return (
          <circle
            key={index}
            {...buttonShape(`${RELATION_WORDS[kind]}, χ² ${chi2.toFixed(1)}, ${outcome}`, isPicked, () =>
              figure.act.select({ kind: "relation", building, index }),
            )}
            class={`relation ${outcome} ${isPicked ? "picked-dot" : ""}`}
            cx={toX(clamp(Math.log10(Math.max(chi2, 1e-9)), LEAST, MOST))}
            cy={toY(row(kind)) + spread(index)}
            r={isPicked ? 6 : 4}
          />
        );
      })}
    </Chart>
  );
}

/** Moves the dots of a row apart, the same way every time. */
function spread(i: number): number {
  return (((i * 0.618034) % 1) - 0.5) * 12;
}

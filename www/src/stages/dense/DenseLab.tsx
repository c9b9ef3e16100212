/** B99 2: the patches of dense matching in plan, by what their planes are, or by how probably they are buildings. */
import "../../app/figures/figures.css";
import { useState } from "preact/hooks";
import { Filmstrip } from "../../app/images/Filmstrip";
import { Choice } from "../../app/parts/Choice";
import { axesOf, Chart, closedPathOf, Fit, type Frame } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { areasOf, equalScales, type PlanColours, planeAt, squaresAt } from "../../app/selection/densePlan";
import type { DensePlanes, Vec2 } from "../../shared/records";
import type { Figure } from "../figure";

const CHOICES: readonly (readonly [PlanColours, string])[] = [
  ["class", "Classes"],
  ["building", "Probability of building"],
];

export function DenseLab({ figure }: { figure: Figure }) {
  const { dense } = figure.results;
  const [shows, show] = useState<PlanColours>("class");
  if (dense === null) {
    return <p class="lab-hint muted">Run the stage: the planes of dense matching appear here, in plan.</p>;
  }
  if (dense.planes.length === 0) {
    return <p class="lab-hint muted">Dense matching found no plane, or is switched off in the parameters.</p>;
  }
  return (
    <div class="split-lab even">
      <div class="chart-lab" data-testid="dense-lab">
        <Choice legend="Colours of the plan" choices={CHOICES} chosen={shows} choose={show} />
        <Fit>{(frame) => <Plan frame={frame} figure={figure} dense={dense} shows={shows} />}</Fit>
      </div>
      <Filmstrip figure={figure} />
    </div>
  );
}

interface PlanProps {
  frame: Frame;
  figure: Figure;
  dense: DensePlanes;
  shows: PlanColours;
}

function Plan({ frame, figure, dense, shows }: PlanProps) {
  const { patches, spacing_m } = dense.trace;
  const places = patches.map(({ middle }) => middle);
  const [x, y] = equalScales(frame, places, spacing_m);
  const [toX, toY] = axesOf(frame, x, y);
  const side = toX(spacing_m) - toX(0);
  const buildings = dense.planes.filter((plane) => plane.class.building > 0.5).length;
  const picked = figure.selection;
  const ring = picked?.kind === "dense" ? (dense.planes[picked.index]?.ring ?? []) : [];
  const outline = closedPathOf(ring.map(([px, py]) => [toX(px), toY(py)] as const));
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="x (m)"
      yTitle="y (m)"
      label={`Plan of ${counted(dense.planes.length, "dense planes")}; buildings, more probably than not: ${buildings}`}
      testid="dense-plan"
      onClick={(...at) => {
        const index = planeAt(dense, at);
        figure.act.select(index === null ? null : { kind: "dense", index });
      }}
    >
      {areasOf(dense, shows).map(({ name, opacity, own }) => (
        <path
          key={`${name} ${opacity}`}
          class={`dense-patches class-${name}`}
          fill-opacity={opacity}
          d={squaresAt(
            own.map((i) => places[i] as Vec2).map(([px, py]) => [toX(px), toY(py)]),
            side,
          )}
          data-count={own.length}
        />
      ))}
      {outline !== "" && <path class="chosen-ring" d={outline} />}
    </Chart>
  );
}

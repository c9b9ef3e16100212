/** B99 2: the patches of dense matching in plan, by what their planes are, or by how probably they are buildings. */
import "../../app/view/figures/figures.css";
import { useState } from "preact/hooks";
import { Choice } from "../../app/parts/Choice";
import { Fit, type Frame } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { areasOf, type PlanColours, planeAt, squaresAt } from "../../app/selection/densePlan";
import { PlanChart } from "../../app/view/figures/PlanChart";
import { SplitLab } from "../../app/view/figures/SplitLab";
import type { DensePlanes } from "../../shared/records";
import { pickedIndex } from "../../shared/selection";
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
    <SplitLab figure={figure} testid="dense-lab">
      <Choice legend="Colours of the plan" choices={CHOICES} chosen={shows} choose={show} />
      <Fit>{(frame) => <Plan frame={frame} figure={figure} dense={dense} shows={shows} />}</Fit>
    </SplitLab>
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
  const buildings = dense.planes.filter((plane) => plane.class.building > 0.5).length;
  return (
    <PlanChart
      frame={frame}
      figure={figure}
      places={places}
      margin={spacing_m}
      label={`Plan of ${counted(dense.planes.length, "dense planes")}; buildings, more probably than not: ${buildings}`}
      testid="dense-plan"
      thingAt={(at) => {
        const index = planeAt(dense, at);
        return index === null ? null : { kind: "dense", index };
      }}
      picked={dense.planes[pickedIndex(figure.selection, "dense")]?.ring}
    >
      {({ at }) =>
        areasOf(dense, shows).map(({ name, opacity, own }) => (
          <path
            key={`${name} ${opacity}`}
            class={`dense-patches class-${name}`}
            fill-opacity={opacity}
            d={squaresAt(
              own.map((i) => at(places[i] ?? [])),
              at([spacing_m])[0] - at([0])[0],
            )}
            data-count={own.length}
          />
        ))
      }
    </PlanChart>
  );
}

/** B99 2: sets of coplanar lines in plan, with their hulls before and their polygons after symmetry. */
import "../../app/figures/figures.css";
import { useState } from "preact/hooks";
import { Filmstrip } from "../../app/images/Filmstrip";
import { Choice } from "../../app/parts/Choice";
import { axesOf, Chart, closedPathOf, Fit, type Frame } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { type CoplanarOutlines, setAt, shownSets } from "../../app/selection/coplanarPlan";
import { equalScales } from "../../app/selection/densePlan";
import { category } from "../../shared/palette";
import { isVerifiedSet } from "../../shared/proposed";
import type { CoplanarSets, Vec3 } from "../../shared/records";
import type { Figure } from "../figure";

const CHOICES: readonly (readonly [CoplanarOutlines, string])[] = [
  ["hull", "Hulls before"],
  ["polygon", "Polygons after"],
  ["both", "Both"],
];

export function CoplanarLab({ figure }: { figure: Figure }) {
  const { coplanar } = figure.results;
  const [shows, show] = useState<CoplanarOutlines>("both");
  if (coplanar === null) {
    return <p class="lab-hint muted">Run the stage: the sets of coplanar lines appear here, in plan.</p>;
  }
  if (coplanar.sets.length === 0) {
    return (
      <p class="lab-hint muted">
        No two lines were grouped. Beside half-planes the stage is switched off: choose the method Coplanar,
        or switch it on in the parameters.
      </p>
    );
  }
  return (
    <div class="split-lab even">
      <div class="chart-lab" data-testid="coplanar-lab">
        <Choice legend="Outlines in the plan" choices={CHOICES} chosen={shows} choose={show} />
        <Fit>{(frame) => <Plan frame={frame} figure={figure} coplanar={coplanar} shows={shows} />}</Fit>
      </div>
      <Filmstrip figure={figure} />
    </div>
  );
}

interface PlanProps {
  frame: Frame;
  figure: Figure;
  coplanar: CoplanarSets;
  shows: CoplanarOutlines;
}

function Plan({ frame, figure, coplanar, shows }: PlanProps) {
  const picked = figure.selection?.kind === "coplanar" ? figure.selection.index : null;
  const shown = shownSets(coplanar, picked);
  const corners = coplanar.sets.filter(isVerifiedSet).flatMap(({ hull, polygon }) => [...hull, ...polygon]);
  const [x, y] = equalScales(
    frame,
    corners.map(([px, py]) => [px, py]),
    1,
  );
  const [toX, toY] = axesOf(frame, x, y);
  const path = (ring: readonly Vec3[]) => closedPathOf(ring.map(([px, py]) => [toX(px), toY(py)] as const));
  const verified = coplanar.sets.filter(isVerifiedSet).length;
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="x (m)"
      yTitle="y (m)"
      label={`Plan of ${counted(coplanar.sets.length, "coplanar sets")}; verified by the photographs: ${verified}`}
      testid="coplanar-plan"
      onClick={(...at) => {
        const index = setAt(coplanar, at);
        figure.act.select(index === null ? null : { kind: "coplanar", index });
      }}
    >
      {shows !== "hull" &&
        shown.map((index) => (
          <path
            key={`polygon ${index}`}
            class="coplanar-polygon"
            stroke={category(index)}
            fill={category(index)}
            d={path(coplanar.sets[index]?.polygon ?? [])}
          />
        ))}
      {shows !== "polygon" &&
        shown.map((index) => (
          <path key={`hull ${index}`} class="coplanar-hull" d={path(coplanar.sets[index]?.hull ?? [])} />
        ))}
      {picked !== null && <path class="chosen-ring" d={path(coplanar.sets[picked]?.polygon ?? [])} />}
    </Chart>
  );
}

/** B99 2: sets of coplanar lines in plan, with their hulls before and their polygons after symmetry. */
import "../../app/view/figures/figures.css";
import { useState } from "preact/hooks";
import { Choice } from "../../app/parts/Choice";
import { Fit, type Frame } from "../../app/parts/charts";
import { counted } from "../../app/parts/counted";
import { type CoplanarOutlines, setAt, shownSets } from "../../app/selection/coplanarPlan";
import { PlanChart } from "../../app/view/figures/PlanChart";
import { SplitLab } from "../../app/view/figures/SplitLab";
import { category } from "../../shared/palette";
import { isVerifiedSet } from "../../shared/proposed";
import type { CoplanarSets } from "../../shared/records";
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
    <SplitLab figure={figure} testid="coplanar-lab">
      <Choice legend="Outlines in the plan" choices={CHOICES} chosen={shows} choose={show} />
      <Fit>{(frame) => <Plan frame={frame} figure={figure} coplanar={coplanar} shows={shows} />}</Fit>
    </SplitLab>
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
  const verified = coplanar.sets.filter(isVerifiedSet);
  const corners = verified.flatMap(({ hull, polygon }) => [...hull, ...polygon]);
  return (
    <PlanChart
      frame={frame}
      figure={figure}
      places={corners.map(([px, py]) => [px, py])}
      margin={1}
      label={`Plan of ${counted(coplanar.sets.length, "coplanar sets")}; verified by the photographs: ${verified.length}`}
      testid="coplanar-plan"
      thingAt={(at) => {
        const index = setAt(coplanar, at);
        return index === null ? null : { kind: "coplanar", index };
      }}
      picked={picked === null ? undefined : coplanar.sets[picked]?.polygon}
    >
      {({ ring }) => (
        <>
          {shows !== "hull" &&
            shown.map((index) => (
              <path
                key={`polygon ${index}`}
                class="coplanar-polygon"
                stroke={category(index)}
                fill={category(index)}
                d={ring(coplanar.sets[index]?.polygon ?? [])}
              />
            ))}
          {shows !== "polygon" &&
            shown.map((index) => (
              <path key={`hull ${index}`} class="coplanar-hull" d={ring(coplanar.sets[index]?.hull ?? [])} />
            ))}
        </>
      )}
    </PlanChart>
  );
}

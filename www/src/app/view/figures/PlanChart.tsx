/** A chart in plan, metres: one scale in both directions, a click picks what lies there, and what is picked has an outline. */
import type { ComponentChildren } from "preact";
import type { Vec2 } from "../../../shared/records";
import type { Selection } from "../../../shared/selection";
import type { Figure } from "../../../stages/figure";
import { axesOf, Chart, closedPathOf, type Frame } from "../../parts/charts";
import { equalScales } from "../../selection/densePlan";

interface Props {
  frame: Frame;
  figure: Figure;
  /** What is to be seen, with a margin about it. */
  places: readonly Vec2[];
  margin: number;
  label: string;
  testid: string;
  /** What lies at a place; null where nothing does. */
  thingAt: (at: Vec2) => Selection | null;
  /** The outline of what is picked. */
  picked: readonly (readonly number[])[] | undefined;
  children: (plan: Plan) => ComponentChildren;
}

interface Plan {
  /** From metres to the chart. */
  at: (place: readonly number[]) => readonly [number, number];
  ring: (places: readonly (readonly number[])[]) => string;
}

export function PlanChart({
  frame,
  figure,
  places,
  margin,
  label,
  testid,
  thingAt,
  picked,
  children,
}: Props) {
  const [x, y] = equalScales(frame, places, margin);
  const [toX, toY] = axesOf(frame, x, y);
  const at = ([px = 0, py = 0]: readonly number[]) => [toX(px), toY(py)] as const;
  const ring: Plan["ring"] = (corners) => closedPathOf(corners.map(at));
  const outline = ring(picked ?? []);
  return (
    <Chart
      frame={frame}
      x={x}
      y={y}
      xTitle="x (m)"
      yTitle="y (m)"
      label={label}
      testid={testid}
      onClick={(...place) => figure.act.select(thingAt(place))}
    >
      {children({ at, ring })}
      {outline !== "" && <path class="chosen-ring" d={outline} />}
    </Chart>
  );
}

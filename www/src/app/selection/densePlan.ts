/** What the plan of dense matching shows, from its patches. */
import type { DensePlanes, Vec2 } from "../../shared/records";
import { type ClassName, likeliestClass, planesOfPatches } from "../../shared/surfaceClass";
import { opacityOf } from "../../viewer/scene/certainty";
import type { Frame, Scale } from "../parts/charts";

/** Patches are coloured by the class of their plane, or by its probability of being a building. */
export type PlanColours = "class" | "building";

interface Area {
  name: ClassName;
  opacity: number;
  /** Indices of patches. */
  own: number[];
}

/** The patches in planes, those that look alike together: thousands of elements would hold the page up. */
export function areasOf(dense: DensePlanes, colours: PlanColours): Area[] {
  const areas = new Map<string, Area>();
  for (const plane of dense.planes) {
    const { name, opacity } = colours === "class" ? classLook(plane.class) : buildingLook(plane.class);
    const key = `${name} ${opacity}`;
    const own = areas.get(key)?.own ?? [];
    areas.set(key, { name, opacity, own: own.concat(plane.patches) });
  }
  return [...areas.values()];
}

type Classes = DensePlanes["planes"][number]["class"];

function classLook(of: Classes): Omit<Area, "own"> {
  const { name, probability } = likeliestClass(of);
  return { name, opacity: opacityOf(probability) };
}

/** In whole tenths; what is certainly none is still seen to be a plane. */
function buildingLook({ building }: Classes): Omit<Area, "own"> {
  return { name: "building", opacity: Math.max(0.05, Math.round(10 * building) / 10) };
}

/** The plane of the patch at a place of the plan; null where there is none. */
export function planeAt(dense: DensePlanes, [x, y]: Vec2): number | null {
  const half = 0.5 * dense.trace.spacing_m;
  const patch = dense.trace.patches.findIndex(
    ({ middle }) => Math.abs(middle[0] - x) <= half && Math.abs(middle[1] - y) <= half,
  );
  const plane = planesOfPatches(dense)[patch] ?? -1;
  return plane < 0 ? null : plane;
}

/** Scales of one size in both directions that have all places in the frame, with a margin about them. */
export function equalScales(frame: Frame, places: readonly Vec2[], margin: number): [Scale, Scale] {
  const inner = [frame.width - frame.left - frame.right, frame.height - frame.top - frame.bottom] as const;
  const [x, y] = [0, 1].map((axis) => {
    const all = places.map((place) => place[axis] as number);
    return { min: all.reduce(lower, Infinity) - margin, max: all.reduce(higher, -Infinity) + margin };
  }) as [Scale, Scale];
  const metresPerUnit = Math.max((x.max - x.min) / inner[0], (y.max - y.min) / inner[1]);
  return [widened(x, metresPerUnit * inner[0]), widened(y, metresPerUnit * inner[1])];
}

// Not `Math.min(...all)`: a call takes fewer arguments than there are patches.
const lower = (a: number, b: number) => Math.min(a, b);
const higher = (a: number, b: number) => Math.max(a, b);

/** A range of this length about the same middle. */
function widened({ min, max }: Scale, length: number): Scale {
  const middle = (min + max) / 2;
  return { min: middle - length / 2, max: middle + length / 2 };
}

/** So much do neighbours overlap, units of the figure: between squares that only touch, the ground shows through. */
const OVERLAP = 0.4;

/** Squares about places, as one path. */
export function squaresAt(places: readonly Vec2[], side: number): string {
  const [half, s] = [(side + OVERLAP) / 2, (side + OVERLAP).toFixed(2)];
  const squares = places.map(
    ([x, y]) => `M${(x - half).toFixed(1)} ${(y - half).toFixed(1)}h${s}v${s}h-${s}z`,
  );
  return squares.join("");
}

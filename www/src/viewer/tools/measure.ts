/** Measuring in space: points, their distance and slope, and the area of three or more. */
import { BufferGeometry, Group, Line, LineBasicMaterial, Points, PointsMaterial, Vector3 } from "three";
import { PALETTE } from "../../shared/palette";
import { disposeObject, type Layer } from "../scene/layer";

export interface Measured {
  points: number;
  /** From the last point but one to the last, metres; null before two points. */
  distanceM: number | null;
  planM: number | null;
  heightM: number | null;
  /** Radians; positive upwards. */
  slope: number | null;
  /** Area of the polygon of three or more points, square metres. */
  areaM2: number | null;
}

/** @param points in the viewer's frame (Y up), metres */
export function measure(points: readonly Vector3[]): Measured {
  const [a, b] = [points.at(-2), points.at(-1)];
  const none = {
    points: points.length,
    distanceM: null,
    planM: null,
    heightM: null,
    slope: null,
    areaM2: null,
  };
  if (a === undefined || b === undefined) {
    return none;
  }
  const step = b.clone().sub(a);
  const planM = Math.hypot(step.x, step.z);
  return {
    points: points.length,
    distanceM: step.length(),
    planM,
    heightM: step.y,
    slope: Math.atan2(step.y, planM),
    areaM2: points.length < 3 ? null : areaOf(points),
  };
}

/** Newell's formula: half the length of the sum of the edges' cross products. */
function areaOf(points: readonly Vector3[]): number {
  const first = points[0] as Vector3;
  const sum = new Vector3();
  points.forEach((point, i) => {
    const next = points[(i + 1) % points.length] as Vector3;
    sum.add(point.clone().sub(first).cross(next.clone().sub(first)));
  });
  return sum.length() / 2;
}

export function buildMeasure(points: readonly Vector3[]): Layer {
  const object = new Group();
  const closed = points.length > 2 ? [...points, points[0] as Vector3] : points;
  const line = new Line(
    new BufferGeometry().setFromPoints([...closed]),
    new LineBasicMaterial({ color: PALETTE.rejected, depthTest: false, transparent: true }),
  );
  const dots = new Points(
    new BufferGeometry().setFromPoints([...points]),
    new PointsMaterial({
      color: PALETTE.rejected,
      size: 9,
      sizeAttenuation: false,
      depthTest: false,
      transparent: true,
    }),
  );
  for (const one of [line, dots]) {
    one.renderOrder = 5;
    one.raycast = () => undefined;
  }
  object.add(line, dots);
  return { object, pick: () => null, highlight: () => undefined, dispose: () => disposeObject(object) };
}

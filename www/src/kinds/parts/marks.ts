/**
 * What things look like in an image: polylines in pixels. Things in space are projected with the view's own matrix, as the
 * viewer's graphics card does; everything else is drawn as the core gave it.
 */
import { PALETTE } from "../../shared/palette";
import type { Vec2, Vec3, ViewInfo } from "../../shared/records";
import type { Figure } from "../../stages/figure";
import type { Shape } from "./shapes";

/** A polyline over an image, pixels. */
export interface Mark {
  points: readonly Vec2[];
  closed?: boolean;
  colour: string;
  /** CSS pixels. */
  width: number;
  dashed?: boolean;
  /** Opacity of the area inside. */
  fill?: number;
  label?: string;
  /**
   * Above the right end, below it, or above the left one: predictions are below the candidates that they meet, points left of the
   * lines through them.
   */
  labelSide?: "left" | "right" | "below";
}

type Style = Omit<Mark, "points">;

/** The view in which marks are drawn, and what is found in it. */
export interface Seen extends Pick<Figure, "results" | "detail"> {
  view: number;
  info: ViewInfo;
}

export const SELECTED_PX = 3.5;
export const THIN_PX = 1.5;
export const CHOSEN: Style = { colour: PALETTE.selected, width: SELECTED_PX };
export const AREA: Style = { ...CHOSEN, width: SELECTED_PX - 1, closed: true, fill: 0.14 };
export const OUTLINE: Style = { ...CHOSEN, width: THIN_PX, closed: true };
const STYLES: Readonly<Record<Shape["role"], Style>> = {
  line: CHOSEN,
  area: AREA,
  before: { ...OUTLINE, colour: PALETTE.grown },
};

/** The image of a point of the local frame; null behind the camera. */
export function project({ projection: p }: Pick<ViewInfo, "projection">, [x, y, z]: Vec3): Vec2 | null {
  const at = (row: number) =>
    (p[4 * row] as number) * x +
    (p[4 * row + 1] as number) * y +
    (p[4 * row + 2] as number) * z +
    (p[4 * row + 3] as number);
  const depth = at(2);
  return depth > 0 ? [at(0) / depth, at(1) / depth] : null;
}

/** A place, as a square that stands on its corner. */
export const diamond = ([x, y]: Vec2, reach: number): Vec2[] => [
  [x - reach, y],
  [x, y - reach],
  [x + reach, y],
  [x, y + reach],
];

/** Shapes as a view sees them. */
export function shapeMarks(
  shapes: readonly Shape[],
  info: ViewInfo,
  styles: Partial<typeof STYLES> = {},
): Mark[] {
  return shapes.flatMap(({ points, role }) => seenFrom(info, points, styles[role] ?? STYLES[role]));
}

/** A polyline of the local frame in a view; none where a part lies behind the camera. */
export function seenFrom(info: ViewInfo, points: readonly Vec3[], style: Style): Mark[] {
  const seen = points.map((point) => project(info, point));
  return seen.every((p) => p !== null) ? [{ points: seen as Vec2[], ...style }] : [];
}

/** Where the picture that is warped onto a side lies in a view. */
export function warpedMarks({ view, detail: { warped } }: Seen): Mark[] {
  const own = warped?.about.views.find((one) => one.view === view);
  return own?.outline == null
    ? []
    : [{ points: own.outline, closed: true, colour: PALETTE.halfPlane, width: 2, fill: 0.12 }];
}

/** The end points of a segment in a list of them; none where it has fewer. */
export function endsIn(data: Float32Array | undefined, index: number, stride: number): Vec2[] {
  const [x0, y0, x1, y1] = data?.subarray(index * stride, index * stride + 4) ?? [];
  return x0 === undefined || y0 === undefined || x1 === undefined || y1 === undefined
    ? []
    : [
        [x0, y0],
        [x1, y1],
      ];
}

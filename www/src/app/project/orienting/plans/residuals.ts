/** What is left at control points and stated positions: the numbers of tables and arrows. */
import type { ControlResidual, OrientationReport } from "../../../../shared/orientation";
import type { Vec3 } from "../../../../shared/records";

/** A place of the plan, and by how far the block is off there in plan, metres; null where that is not known. */
export interface PlanResidual {
  name: string;
  place: Vec3;
  offset: [number, number] | null;
  kind: "used" | "check" | "wrong";
}

/** Those of control points and check points, or else of stated positions; `centres` are those of the photographs. */
export function planResiduals(
  { control, photos }: Pick<OrientationReport, "control" | "photos">,
  centres: readonly Vec3[],
): PlanResidual[] {
  if (control.length > 0) {
    return control.flatMap(({ name, place_m: place, residual_m: residual, role, agrees }) => {
      const [x, y] = residual ?? [];
      const offset: [number, number] | null = typeof x === "number" && typeof y === "number" ? [x, y] : null;
      const kind = agrees ? (role?.is_check ? "check" : "used") : "wrong";
      return place == null ? [] : [{ name, place, offset, kind }];
    });
  }
  return photos.flatMap(({ file, residual_m: residual }, i) => {
    const place = centres[i];
    return residual === null || place === undefined
      ? []
      : [{ name: file, place, offset: [residual[0], residual[1]], kind: "used" }];
  });
}

/** What a point is for, in words. */
export function roleText(role: ControlResidual["role"]): string {
  const what = role?.is_check ? "check" : "control";
  const known = role?.known ?? "all";
  return known === "all" ? what : `${what}, ${known} only`;
}

/** Root mean square residuals in plan and in height, metres; null where none is known. */
export function rms(points: readonly ControlResidual[]): [number | null, number | null] {
  const of = (axes: readonly (0 | 1 | 2)[]) => {
    const squares = points.flatMap(({ residual_m: residual }) => {
      const values = axes.map((axis) => residual?.[axis] ?? null);
      return values.includes(null) ? [] : [values.reduce((sum: number, v) => sum + (v ?? 0) ** 2, 0)];
    });
    return squares.length === 0 ? null : Math.sqrt(squares.reduce((a, b) => a + b) / squares.length);
  };
  return [of([0, 1]), of([2])];
}

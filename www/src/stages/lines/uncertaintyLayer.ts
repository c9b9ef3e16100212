/**
 * The uncertainty of 3D lines: a tube between the error ellipses of both ends, drawn larger than it is by a factor that
 * the legend states.
 */
import { BufferAttribute, BufferGeometry, Matrix3, Mesh, MeshBasicMaterial, Vector3 } from "three";
import { LINE_STRIDE } from "../../shared/flatArrays";
import { PALETTE } from "../../shared/palette";
import type { LineRecord } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { BOTH_SIDES, type Layer } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";

/** xx, xy, xz, yy, yz, zz of a symmetric matrix, m². */
export type Covariance = LineRecord["covariance"][number];

/** Corners of an ellipse. */
const CORNERS = 16;
/** Alone, and while something is selected. */
const OPACITY = [0.5, 0.12] as const;
/** The middle tube is to have at most this radius, metres: seen beside a house, and smaller. */
const WANTED_M = 1;
const FACTORS = [1, 2, 5, 10, 20, 50, 100] as const;

/** The round factor by which tubes of these lines are drawn larger. */
export function enlargement(records: readonly LineRecord[]): number {
  const sigmas = records.map(({ sigma_m }) => sigma_m).sort((a, b) => a - b);
  const middle = sigmas[Math.floor(sigmas.length / 2)] ?? 0;
  return [...FACTORS].reverse().find((factor) => factor * middle <= WANTED_M) ?? 1;
}

/**
 * @param lines p0 and p1 of each 3D line, local frame, metres
 * @param linesOf the lines that belong to a selection
 */
export function buildUncertainty(
  lines: Float64Array,
  records: readonly LineRecord[],
  factor: number,
  linesOf: (selection: Selection | null) => readonly number[],
): Layer {
  const tubes = records.map((record, i) => tubeOf(lines, i, record, factor));
  const drawn = meshOf(tubes, PALETTE.merged);
  return partsLayer({
    kind: "line",
    parts: [{ drawn, opacity: OPACITY, things: tubes.map((_, i) => i), facesEach: 2 * CORNERS }],
    chosen: (_, selection) => {
      const own = linesOf(selection).flatMap((index) => tubes[index] ?? []);
      return own.length === 0 ? null : meshOf([own], PALETTE.selected);
    },
  });
}

/** The rings of both ends, one after the other: three numbers a corner. */
function tubeOf(lines: Float64Array, index: number, record: LineRecord, factor: number): number[] {
  const ends = [0, 3].map((at) => new Vector3().fromArray(lines, index * LINE_STRIDE + at));
  const [p0, p1] = ends as [Vector3, Vector3];
  const [u, v] = across(p1.clone().sub(p0).normalize());
  return ends.flatMap((end, k) =>
    ellipse(record.covariance[k] as Covariance, u, v).flatMap((offset) =>
      offset.multiplyScalar(factor).add(end).toArray(),
    ),
  );
}

/** Two unit vectors across a direction, the second as upright as may be. */
function across(direction: Vector3): [Vector3, Vector3] {
  const up = Math.abs(direction.z) < 0.99 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0);
  const u = direction.clone().cross(up).normalize();
  return [u, u.clone().cross(direction)];
}

/**
 * The ellipse of one standard deviation in the plane of two unit vectors: the unit circle under the symmetric root of
 * the covariance there, (M + sqrt(det M) I) / sqrt(tr M + 2 sqrt(det M)).
 */
export function ellipse(covariance: Covariance, u: Vector3, v: Vector3): Vector3[] {
  const [xx, xy, xz, yy, yz, zz] = covariance;
  const by = new Matrix3(xx, xy, xz, xy, yy, yz, xz, yz, zz);
  const ofV = v.clone().applyMatrix3(by);
  const [a, b, c] = [u.dot(u.clone().applyMatrix3(by)), u.dot(ofV), v.dot(ofV)];
  const root = Math.sqrt(Math.max(0, a * c - b * b));
  const scale = 1 / Math.sqrt(Math.max(Number.MIN_VALUE, a + c + 2 * root));
  return Array.from({ length: CORNERS }, (_, i) => {
    const angle = (2 * Math.PI * i) / CORNERS;
    const [x, y] = [Math.cos(angle), Math.sin(angle)];
    return new Vector3()
      .addScaledVector(u, scale * ((a + root) * x + b * y))
      .addScaledVector(v, scale * (b * x + (c + root) * y));
  });
}

function meshOf(tubes: readonly number[][], colour: string): Mesh<BufferGeometry, MeshBasicMaterial> {
  const positions = Float32Array.from(tubes.flat());
  const count = positions.length / (6 * CORNERS);
  const indices: number[] = [];
  for (let tube = 0; tube < count; tube += 1) {
    const start = 2 * CORNERS * tube;
    for (let i = 0; i < CORNERS; i += 1) {
      const [a, b] = [start + i, start + ((i + 1) % CORNERS)];
      indices.push(a, b, b + CORNERS, a, b + CORNERS, a + CORNERS);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(indices);
  const style = { transparent: true, opacity: OPACITY[0], depthWrite: false, ...BOTH_SIDES };
  return new Mesh(geometry, new MeshBasicMaterial({ color: colour, ...style }));
}

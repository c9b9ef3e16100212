/** Half-planes as fans: a strip from the 3D line into the half-plane, fading away from the line. */
import { BufferGeometry, LineBasicMaterial, LineSegments, Vector3 } from "three";
import { LINE_STRIDE, lineAt } from "../../shared/flatArrays";
import { add, scaled, thetaFrame } from "../../shared/linear";
import { PALETTE } from "../../shared/palette";
import { type HalfPlane, isRejected, type Side, type SideRecord, type Vec3 } from "../../shared/records";
import { fanRing, ringFrom } from "../../viewer/scene/fanRing";
import { zUpGroup } from "../../viewer/scene/frame";
import { colouredMesh, type Layer, layerOf, quads, rgb } from "../../viewer/scene/layer";
import { partsLayer } from "../../viewer/scene/partsLayer";

const REJECTED_OFFSET_M = 0.25;
const ALPHA = { near: 0.75, far: 0.08 };
/** Alone, and while something is selected. */
const OPACITY = { fans: [1, 0.3], rejected: [0.8, 0.3] } as const;

/**
 * @param lines p0 and p1 of each 3D line, local frame, metres
 * @param sides every side of every line: the rejected ones become thin red lines beside theirs
 */
export function buildFans(
  halfPlanes: readonly HalfPlane[],
  lines: Float64Array,
  sides: readonly SideRecord[] = [],
): Layer {
  // While lines have been found anew, these are still of the earlier ones.
  const areOfLines = [...halfPlanes, ...sides].every(({ line }) => (line + 1) * LINE_STRIDE <= lines.length);
  const corners = areOfLines ? halfPlanes.map((halfPlane) => fanCorners(halfPlane, lines)) : [];
  const rejectedSides = areOfLines ? sides.filter(isRejected) : [];
  return partsLayer({
    kind: "halfplane",
    parts: [
      {
        drawn: fanMesh(corners, PALETTE.halfPlane),
        opacity: OPACITY.fans,
        things: corners.map((_, i) => i),
        facesEach: 2,
      },
      {
        drawn: rejectedLines(rejectedSides, lines),
        opacity: OPACITY.rejected,
        pick: (hit) => {
          const side = rejectedSides[Math.floor((hit.index ?? -1) / 2)];
          return side === undefined ? null : { kind: "side", line: side.line, side: side.side };
        },
      },
    ],
    chosen: (index) => {
      const corner = corners[index];
      return corner === undefined ? null : fanMesh([corner], PALETTE.selected, 2);
    },
  });
}

/** The half-plane that is being turned by hand: one fan at `theta` (radians) about the line from `p0` to `p1`. */
export function buildTurning(ends: readonly [Vec3, Vec3], side: Side, theta: number): Layer {
  const object = zUpGroup();
  const { left, up } = thetaFrame(...ends);
  const outward = scaled(left, side === "left" ? Math.cos(theta) : -Math.cos(theta));
  const ring = ringFrom(ends, add(outward, up, Math.sin(theta)));
  object.add(fanMesh([ring.map((corner) => new Vector3(...corner))], PALETTE.selected, 3));
  return layerOf(object);
}

/** A thin line beside the 3D line, on the rejected side of it. */
function rejectedLines(
  sides: readonly SideRecord[],
  lines: Float64Array,
): LineSegments<BufferGeometry, LineBasicMaterial> {
  const points = sides.flatMap(({ line, side }) => {
    const [p0, p1] = (lineAt(lines, line) ?? []).map((end) => new Vector3(...end)) as [Vector3, Vector3];
    const left = new Vector3(p0.y - p1.y, p1.x - p0.x, 0).normalize();
    const away = left.multiplyScalar(side === "left" ? REJECTED_OFFSET_M : -REJECTED_OFFSET_M);
    return [p0.add(away), p1.add(away)];
  });
  const material = new LineBasicMaterial({ color: PALETTE.rejected, transparent: true });
  return new LineSegments(new BufferGeometry().setFromPoints(points), material);
}

/** Start and end on the line, then end and start away from it. */
export function fanCorners(halfPlane: HalfPlane, lines: Float64Array): Vector3[] {
  return fanRing(halfPlane, lines).map((corner) => new Vector3(...corner));
}

/** @param order of those that are drawn over all others */
function fanMesh(corners: readonly Vector3[][], colour: string, order = 0) {
  const base = rgb(colour);
  const positions = corners.flatMap((fan) => fan.flatMap((corner) => corner.toArray()));
  const colours = corners.flatMap(() => [
    ...[...base, ALPHA.near, ...base, ALPHA.near],
    ...[...base, ALPHA.far, ...base, ALPHA.far],
  ]);
  const mesh = colouredMesh(positions, colours, quads(corners.length), { depthWrite: false });
  mesh.renderOrder = order;
  return mesh;
}

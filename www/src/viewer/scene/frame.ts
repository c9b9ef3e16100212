/**
 * The only place where the local frame (metres, Z up) becomes the viewer's (Y up): (x, y, z) -> (x, z, -y),
 * as in the exported GLB, so that both coincide.
 */
import { Group, Vector3 } from "three";
import type { Vec3 } from "../../shared/records";

/** A group whose children are in the local frame. */
export function zUpGroup(): Group {
  const group = new Group();
  group.rotation.x = -Math.PI / 2;
  group.updateMatrix();
  return group;
}

/** A point or vector of the local frame in the viewer's. */
export function yUp([x, y, z]: Vec3): Vector3 {
  return new Vector3(x, z, -y);
}

/** The way back. */
export function zUp({ x, y, z }: Vector3): [number, number, number] {
  return [x, -z, y];
}

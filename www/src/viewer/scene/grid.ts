/** The grid on the ground below what is shown. */
import { GridHelper, type LineBasicMaterial, type Sphere } from "three";
import { type Layer, layerOf } from "./layer";

export const GRID_STEP_M = 10;
/** Farther out it would be a grey haze. */
const MAX_GRID_M = 300;

/** Below a sphere of the viewer's frame, at a height. */
export function buildGrid({ center, radius }: Sphere, floor: number, colour: string): Layer {
  const steps = 2 * Math.ceil(Math.min(MAX_GRID_M, 1.5 * radius) / GRID_STEP_M);
  const object = new GridHelper(steps * GRID_STEP_M, steps, colour, colour);
  const snapped = (value: number) => Math.round(value / GRID_STEP_M) * GRID_STEP_M;
  object.position.set(snapped(center.x), floor, snapped(center.z));
  (object.material as LineBasicMaterial).depthWrite = false;
  object.raycast = () => undefined;
  return layerOf(object);
}

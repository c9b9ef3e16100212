/** Dots that can be dragged: level, or upright with Shift. */
import {
  BufferGeometry,
  type Camera,
  Plane,
  Points,
  PointsMaterial,
  type Ray,
  type Vector2,
  Vector3,
} from "three";
import { nearestOf } from "../../shared/linear";
import { PALETTE } from "../../shared/palette";
import { type Layer, layerOf } from "../scene/layer";

/** A dot is taken within this distance, CSS pixels. */
const REACH_PX = 12;
const DOT_PX = 11;
/** Nothing is dragged further, metres: near the horizon a pixel is a field. */
const FURTHEST_M = 30;

/** Of the canvas, or of its half, CSS pixels. */
export interface Size {
  width: number;
  height: number;
}

/** The dot at a place of the canvas, in clip coordinates; -1 for none. */
export function handleAt(at: Vector2, handles: readonly Vector3[], camera: Camera, size: Size): number {
  const nearest = nearestOf(handles, (handle) => pixelsAway(handle, at, camera, size), REACH_PX);
  return nearest === null ? -1 : handles.indexOf(nearest);
}

/** How far from a place of the canvas, in clip coordinates, a point is seen, CSS pixels. */
export function pixelsAway(point: Vector3, at: Vector2, camera: Camera, size: Size): number {
  const { x, y } = point.clone().project(camera);
  return Math.hypot(((x - at.x) * size.width) / 2, ((y - at.y) * size.height) / 2);
}

/** Where a dot is dragged to: on its level, or above and below it. */
export function dragged(from: Vector3, ray: Ray, isUpright: boolean): Vector3 | null {
  const up = new Vector3(0, 1, 0);
  const facing = ray.direction.clone().setY(0).normalize();
  const plane = new Plane().setFromNormalAndCoplanarPoint(isUpright ? facing : up, from);
  const hit = ray.intersectPlane(plane, new Vector3());
  if (hit === null || hit.distanceTo(from) > FURTHEST_M) {
    return null;
  }
  return isUpright ? new Vector3(from.x, hit.y, from.z) : hit;
}

export function buildHandles(handles: readonly Vector3[]): Layer {
  const object = dots(handles, PALETTE.selected, DOT_PX);
  object.renderOrder = 10;
  return layerOf(object);
}

/** Dots of one size on the screen, over whatever lies before them. */
export function dots(places: readonly Vector3[], color: string, size: number, transparent = false): Points {
  return new Points(
    new BufferGeometry().setFromPoints([...places]),
    new PointsMaterial({ color, size, sizeAttenuation: false, depthTest: false, transparent }),
  );
}

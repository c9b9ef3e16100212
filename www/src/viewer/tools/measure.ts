/** Measuring in space: points, their distance and slope, and the area of three or more. */
import {
  BufferGeometry,
  type Camera,
  Group,
  Line,
  LineBasicMaterial,
  type Ray,
  type Vector2,
  Vector3,
} from "three";
import { areaVector, edgesOf, nearestOf, norm } from "../../shared/linear";
import { PALETTE } from "../../shared/palette";
import { type Layer, layerOf } from "../scene/layer";
import { dots, pixelsAway, type Size } from "./handles";

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

/** A corner of the model that points are drawn to, viewer's frame, and its standard deviations in x, y and z, metres. */
export interface Corner {
  at: Vector3;
  sigma: Vector3 | null;
}

/** Where a point was taken: at a corner, on an edge, on a face or another surface, or on the level ground below all. */
export interface Taken {
  at: Vector3;
  on: "corner" | "edge" | "face" | "ground";
  /** Standard deviations; on an edge not more than this, whatever its ends have in common. */
  sigma: Vector3 | null;
}

/** Corners and edges draw points to them within this distance, CSS pixels. */
const REACH_PX = 10;
/** What lies this much behind the surface that is seen is hidden by it, metres. */
const HIDDEN_M = 0.5;

/**
 * The corner of a ring near a place of the canvas, or else the place of an edge; null where both are far or hidden.
 *
 * @param at in clip coordinates
 * @param seen the surface at that place
 */
export function snapped(
  { at, ray, camera, size }: { at: Vector2; ray: Ray; camera: Camera; size: Size },
  rings: readonly (readonly Corner[])[],
  seen: Vector3 | null,
): Taken | null {
  const farthest = (seen?.distanceTo(ray.origin) ?? Number.POSITIVE_INFINITY) + HIDDEN_M;
  const nearest = (places: readonly Taken[]): Taken | null => {
    const before = places.filter((place) => place.at.distanceTo(ray.origin) <= farthest);
    return nearestOf(before, (place) => pixelsAway(place.at, at, camera, size), REACH_PX);
  };
  const corners = rings.flat().map(({ at, sigma }): Taken => ({ at, on: "corner", sigma }));
  const edges = rings.flatMap((ring) => edgesOf(ring).map((ends) => onEdge(ray, ...ends)));
  return nearest(corners) ?? nearest(edges);
}

/** The place of an edge that is nearest to a ray. */
function onEdge(ray: Ray, a: Corner, b: Corner): Taken {
  const place = new Vector3();
  ray.distanceSqToSegment(a.at, b.at, undefined, place);
  const share = a.at.distanceTo(place) / Math.max(1e-9, a.at.distanceTo(b.at));
  const sigma = a.sigma === null || b.sigma === null ? null : a.sigma.clone().lerp(b.sigma, share);
  return { at: place, on: "edge", sigma };
}

/** @param points in the viewer's frame (Y up), metres */
export function measure(points: readonly Vector3[]): Measured {
  const [a, b] = [points.at(-2), points.at(-1)];
  if (a === undefined || b === undefined) {
    const none = { distanceM: null, planM: null, heightM: null, slope: null, areaM2: null };
    return { points: points.length, ...none };
  }
  const step = b.clone().sub(a);
  const planM = Math.hypot(step.x, step.z);
  return {
    points: points.length,
    distanceM: step.length(),
    planM,
    heightM: step.y,
    slope: Math.atan2(step.y, planM),
    areaM2: points.length < 3 ? null : norm(areaVector(points.map((point) => point.toArray()))),
  };
}

export function buildMeasure(points: readonly Vector3[]): Layer {
  const object = new Group();
  const closed = points.length > 2 ? [...points, points[0] as Vector3] : points;
  const line = new Line(
    new BufferGeometry().setFromPoints([...closed]),
    new LineBasicMaterial({ color: PALETTE.rejected, depthTest: false, transparent: true }),
  );
  for (const one of [line, dots(points, PALETTE.rejected, 9, true)]) {
    one.renderOrder = 5;
    one.raycast = () => undefined;
    object.add(one);
  }
  return layerOf(object);
}

/** Spheres around what is shown, in the viewer's frame. */
import { Box3, type Object3D, Sphere, Vector3 } from "three";
import { LINE_STRIDE } from "../../shared/flatArrays";
import type { Facet, Vec3 } from "../../shared/records";
import { yUp } from "./frame";

/** This share of the coordinates at either end is left out, so that one stray line does not set the scale. */
const OUTLIERS = 0.04;
const MIN_RADIUS_M = 5;

export function boundsOf(object: Object3D): Sphere {
  return padded(new Box3().setFromObject(object));
}

export function boundsOfFacets(facets: readonly Facet[]): Sphere {
  return padded(new Box3().setFromPoints(facets.flatMap(({ outer }) => outer.map(yUp))));
}

/** @param lines p0 and p1 of each line, local frame, metres */
export function boundsOfLines(lines: Float64Array): Sphere {
  if (lines.length < LINE_STRIDE) {
    return new Sphere(new Vector3(), 4 * MIN_RADIUS_M);
  }
  const axes = [0, 1, 2].map((axis) => Float64Array.from(lines.filter((_, i) => i % 3 === axis)).sort());
  const at = (share: number) =>
    axes.map((values) => values[Math.round(share * (values.length - 1))] as number) as [
      number,
      number,
      number,
    ];
  return padded(new Box3().setFromPoints([yUp(at(OUTLIERS)), yUp(at(1 - OUTLIERS))]));
}

/** A sphere that holds the cameras, too. */
export function withCameras(sphere: Sphere, centres: readonly Vec3[]): Sphere {
  const box = new Box3().setFromPoints(centres.map(yUp));
  box.expandByPoint(sphere.center);
  return padded(box);
}

function padded(box: Box3): Sphere {
  const sphere = box.getBoundingSphere(new Sphere());
  sphere.radius = Math.max(MIN_RADIUS_M, sphere.radius);
  return sphere;
}

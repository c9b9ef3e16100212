/** The views in space: each camera's centre and its frustum down to the ground. */
import {
  BufferGeometry,
  LineBasicMaterial,
  LineSegments,
  Matrix3,
  Points,
  PointsMaterial,
  Vector3,
} from "three";
import { PALETTE } from "../shared/palette";
import type { ViewInfo } from "../shared/results";
import type { Selection } from "../shared/selection";
import { zUpGroup } from "./frame";
import { disposeObject, type Layer } from "./layer";

/** @param target the middle of what the views look at, local frame, metres; its height is the frusta's end */
export function buildCameras(views: readonly ViewInfo[], target: Vector3): Layer {
  const object = zUpGroup();
  const centres = views.map(({ center }) => new Vector3(...center));
  const points = new Points(
    new BufferGeometry().setFromPoints(centres),
    new PointsMaterial({ color: PALETTE.matched, size: 9, sizeAttenuation: false }),
  );
  const rays = views.map((view) => frustumEdges(view, target));
  const lines = rays.map((edges) => edgeLines(edges));
  object.add(points, ...lines);

  return {
    object,
    pick: (hit) => {
      const index = hit.object === points ? (hit.index ?? -1) : lines.indexOf(hit.object as LineSegments);
      return index < 0 ? null : { kind: "view", index };
    },
    highlight(selection: Selection | null) {
      lines.forEach((line, view) => {
        const material = line.material as LineBasicMaterial;
        const isSelected = selection?.kind === "view" && selection.index === view;
        material.color.set(isSelected ? PALETTE.selected : PALETTE.matched);
        material.opacity = isSelected ? 1 : 0.35;
      });
    },
    dispose: () => disposeObject(object),
  };
}

/** Pairs of points: from the centre to the ground corners and around them, or one line of sight. */
function frustumEdges(view: ViewInfo, target: Vector3): Vector3[] {
  const centre = new Vector3(...view.center);
  const corners = groundCorners(view, centre, target.z);
  if (corners === null) {
    return [centre, target];
  }
  return corners.flatMap((corner, i) => [centre, corner, corner, corners[(i + 1) % 4] as Vector3]);
}

/** Where the rays of the image corners meet the height `z`; null where one never does. */
export function groundCorners(view: ViewInfo, centre: Vector3, z: number): Vector3[] | null {
  const p = view.projection;
  if (p.length !== 12) {
    return null;
  }
  const [a, b, c, , d, e, f, , g, h, i] = p as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  const rayOfPixel = new Matrix3(a, b, c, d, e, f, g, h, i).invert();
  const corners: Vector3[] = [];
  for (const [x, y] of [
    [0, 0],
    [view.width, 0],
    [view.width, view.height],
    [0, view.height],
  ] as const) {
    const ray = new Vector3(x, y, 1).applyMatrix3(rayOfPixel);
    const depth = (z - centre.z) / ray.z;
    if (!Number.isFinite(depth) || depth <= 0) {
      return null;
    }
    corners.push(centre.clone().addScaledVector(ray, depth));
  }
  return corners;
}

function edgeLines(points: Vector3[]): LineSegments {
  const material = new LineBasicMaterial({ color: PALETTE.matched, transparent: true, opacity: 0.35 });
  return new LineSegments(new BufferGeometry().setFromPoints(points), material);
}

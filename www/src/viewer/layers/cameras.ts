/** The views in space: each camera's centre, its frustum down to the ground, and its photograph across the frustum. */
import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  LineBasicMaterial,
  LineSegments,
  Matrix3,
  Mesh,
  MeshBasicMaterial,
  Points,
  PointsMaterial,
  SRGBColorSpace,
  Vector3,
} from "three";
import { rectangle } from "../../shared/linear";
import { PALETTE } from "../../shared/palette";
import type { ViewInfo } from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { zUpGroup } from "../scene/frame";
import { BOTH_SIDES, type Layer, layerOf } from "../scene/layer";

/**
 * Width of a photograph at its camera over the distance of the nearest other camera: frusta of long focal lengths are so
 * narrow that nothing could be seen at their own scale.
 */
const PHOTO_WIDTH = 0.4;
const PHOTO_OPACITY = 0.92;
/** Longer side of a photograph's texture, pixels. */
const TEXTURE_PX = 512;

/**
 * @param target the middle of what the views look at, local frame, metres; its height is the frusta's end
 * @param images the photographs, where there are any
 */
export function buildCameras(
  views: readonly ViewInfo[],
  target: Vector3,
  images: readonly ImageBitmap[] = [],
): Layer {
  const object = zUpGroup();
  const centres = views.map(({ center }) => new Vector3(...center));
  const points = new Points(
    new BufferGeometry().setFromPoints(centres),
    new PointsMaterial({ color: PALETTE.matched, size: 9, sizeAttenuation: false }),
  );
  const rays = views.map((view) => frustumEdges(view, target));
  const lines = rays.map((edges) => edgeLines(edges));
  const width = PHOTO_WIDTH * nearestDistance(centres);
  const photos = views.map((view, i) => photoMesh(view, target, width, images[i]));
  object.add(points, ...lines, ...photos.filter((photo) => photo !== null));

  return layerOf(object, {
    pick: (hit) => {
      const index =
        hit.object === points
          ? (hit.index ?? -1)
          : Math.max(lines.indexOf(hit.object as LineSegments), photos.indexOf(hit.object as Mesh));
      return index < 0 ? null : { kind: "view", index };
    },
    highlight(selection: Selection | null) {
      lines.forEach((line, view) => {
        const material = line.material as LineBasicMaterial;
        const isSelected = selection?.kind === "view" && selection.index === view;
        material.color.set(isSelected ? PALETTE.selected : PALETTE.matched);
        material.opacity = isSelected ? 1 : 0.35;
        const photo = photos[view];
        if (photo != null) {
          (photo.material as MeshBasicMaterial).opacity =
            selection === null || isSelected ? PHOTO_OPACITY : 0.4;
        }
      });
    },
  });
}

function nearestDistance(centres: readonly Vector3[]): number {
  const distances = centres.flatMap((a, i) => centres.slice(i + 1).map((b) => a.distanceTo(b)));
  return Math.min(...distances, 1e4);
}

/** The photograph at its camera, enlarged, on a plane parallel to the image: there it is undistorted. */
function photoMesh(
  view: ViewInfo,
  target: Vector3,
  width: number,
  image: ImageBitmap | undefined,
): Mesh | null {
  const centre = new Vector3(...view.center);
  const corners = groundCorners(view, centre, target.z);
  if (image === undefined || corners === null) {
    return null;
  }
  // Corners at equal depth along the viewing axis, which is the third row of P.
  const axis = new Vector3(...(view.projection.slice(8, 11) as [number, number, number])).normalize();
  const flat = corners.map((corner) => {
    const ray = corner.clone().sub(centre);
    return ray.divideScalar(ray.dot(axis));
  });
  const middle = flat.reduce((sum, corner) => sum.add(corner), new Vector3()).divideScalar(flat.length);
  const scale = width / (flat[0] as Vector3).distanceTo(flat[1] as Vector3);
  const placed = flat.map((corner) => corner.clone().sub(middle).multiplyScalar(scale).add(centre));
  const geometry = new BufferGeometry().setFromPoints(placed);
  geometry.setAttribute("uv", new BufferAttribute(Float32Array.from([0, 1, 1, 1, 1, 0, 0, 0]), 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const material = new MeshBasicMaterial({
    map: textureOf(image),
    ...BOTH_SIDES,
    transparent: true,
    opacity: PHOTO_OPACITY,
  });
  return new Mesh(geometry, material);
}

function textureOf(image: ImageBitmap): CanvasTexture {
  const scale = Math.min(1, TEXTURE_PX / Math.max(image.width, image.height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(image.width * scale);
  canvas.height = Math.round(image.height * scale);
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
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
  // The first three columns of P, by columns as three.js has them.
  const columns = [0, 1, 2].flatMap((column) => [p[column], p[column + 4], p[column + 8]] as number[]);
  const rayOfPixel = new Matrix3().fromArray(columns).invert();
  const corners: Vector3[] = [];
  for (const [x, y] of rectangle([0, 0], [view.width, view.height])) {
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

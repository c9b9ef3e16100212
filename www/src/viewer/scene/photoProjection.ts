/**
 * Looking through a view's own camera: the projection matrix of P, so that model and photograph coincide. Cameras of crops
 * have their principal point far outside the image, which no field of view can state.
 */
import { Matrix4, Vector4 } from "three";
import type { ViewInfo } from "../../shared/records";

/** The part of the canvas that the photograph fills, keeping its shape: shares of width and height. */
export function fitShares(view: { width: number; height: number }, canvasAspect: number): [number, number] {
  const aspect = view.width / view.height;
  return aspect > canvasAspect ? [1, canvasAspect / aspect] : [aspect / canvasAspect, 1];
}

/** From the viewer's frame (Y up) to clip space; near and far are depths in metres. */
export function clipFromViewer(view: ViewInfo, canvasAspect: number, near: number, far: number): Matrix4 {
  const p = view.projection;
  const [sx, sy] = fitShares(view, canvasAspect);
  // Depth in metres: the third row of P scaled to a unit direction.
  const scale = 1 / Math.hypot(...p.slice(8, 11));
  const row = (i: number) => new Vector4().fromArray(p, 4 * i).multiplyScalar(scale);
  const [u, v, w] = [row(0), row(1), row(2)];
  const mix = (a: Vector4, fa: number, b: Vector4, fb: number) =>
    a.clone().multiplyScalar(fa).addScaledVector(b, fb);
  const x = mix(u, (2 * sx) / view.width, w, -sx);
  const y = mix(v, (-2 * sy) / view.height, w, sy);
  const range = far - near;
  const z = mix(w, (far + near) / range, new Vector4(0, 0, 0, 1), (-2 * far * near) / range);
  // Columns for the viewer's axes: local (x, y, z) = viewer (x, -z, y).
  const viewer = (of: Vector4) => [of.x, of.z, -of.y, of.w] as const;
  return new Matrix4().set(...viewer(x), ...viewer(y), ...viewer(z), ...viewer(w));
}

/** Photographs as pictures of this part of the page. */
import { files } from "../../state/project";

/** Width of the pictures, pixels. */
export const PICTURE_PX = 900;

/** Pixels as they are stored: the orientation is that of the file, however a header has it turned. */
export async function pictureOf(path: string): Promise<ImageBitmap | null> {
  const blob = files.value.find((file) => file.path === path)?.blob;
  try {
    return blob === undefined
      ? null
      : await createImageBitmap(blob, {
          resizeWidth: PICTURE_PX,
          resizeQuality: "medium",
          imageOrientation: "none",
        });
  } catch {
    return null;
  }
}

/** A square of a photograph from its left upper corner, pixels as they are stored; null where it cannot be decoded. */
export async function cutOf(
  path: string,
  left: number,
  top: number,
  side: number,
): Promise<ImageBitmap | null> {
  const blob = files.value.find((file) => file.path === path)?.blob;
  try {
    return blob === undefined
      ? null
      : await createImageBitmap(blob, left, top, side, side, { imageOrientation: "none" });
  } catch {
    return null;
  }
}

/** A polygon on a photograph: x, y of points in its pixels, drawn with an outline that any background shows. */
export function drawCurve(
  context: CanvasRenderingContext2D,
  curve: Float32Array,
  scale: number,
  [casing, colour]: readonly [string, string],
): void {
  const path = new Path2D();
  for (let i = 0; i + 1 < curve.length; i += 2) {
    path.lineTo((curve[i] as number) * scale, (curve[i + 1] as number) * scale);
  }
  context.lineWidth = 5;
  context.strokeStyle = casing;
  context.stroke(path);
  context.lineWidth = 2.5;
  context.strokeStyle = colour;
  context.stroke(path);
}

export function nameOf(path: string): string {
  return path.slice(path.lastIndexOf("/") + 1);
}

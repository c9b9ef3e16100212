/** Photographs as pictures of this part of the page. */
import { files } from "../../state/project";

/** Width of the pictures, pixels. */
export const PICTURE_PX = 900;

/** Pixels as they are stored: the orientation is that of the file, however a header has it turned. */
export function pictureOf(path: string): Promise<ImageBitmap | null> {
  return decoded(path, (blob) =>
    createImageBitmap(blob, {
      resizeWidth: PICTURE_PX,
      resizeQuality: "medium",
      imageOrientation: "none",
    }),
  );
}

/** A square of a photograph from its left upper corner, pixels as they are stored. */
export function cutOf(path: string, left: number, top: number, side: number): Promise<ImageBitmap | null> {
  return decoded(path, (blob) =>
    createImageBitmap(blob, left, top, side, side, { imageOrientation: "none" }),
  );
}

/** Null where it cannot be decoded. */
async function decoded(path: string, decode: (blob: Blob) => Promise<ImageBitmap>) {
  const blob = files.value.find((file) => file.path === path)?.blob;
  try {
    return blob === undefined ? null : await decode(blob);
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
  strokeCased(context, path, casing, colour);
}

/** A line with an outline that any background shows. */
export function strokeCased(
  context: CanvasRenderingContext2D,
  path: Path2D,
  casing: string,
  colour: string,
): void {
  context.lineWidth = 5;
  context.strokeStyle = casing;
  context.stroke(path);
  context.lineWidth = 2.5;
  context.strokeStyle = colour;
  context.stroke(path);
}

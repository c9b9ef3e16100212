/** Line segments of constant width on the screen. */
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { LINE_STRIDE } from "../../shared/flatArrays";
import { edgesOf } from "../../shared/linear";
import type { Vec3 } from "../../shared/records";
import { rgb } from "./layer";

/**
 * @param positions both ends of each segment, six numbers
 * @param colours one for each segment, or one for all
 */
export function strokes(
  positions: ArrayLike<number>,
  colours: string | readonly string[],
  widthPx: number,
): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(Float32Array.from(positions));
  const style = { linewidth: widthPx, transparent: true };
  if (typeof colours === "string") {
    return new LineSegments2(geometry, new LineMaterial({ color: colours, ...style }));
  }
  geometry.setColors(colours.flatMap((colour) => [...rgb(colour), ...rgb(colour)]));
  return new LineSegments2(geometry, new LineMaterial({ vertexColors: true, ...style }));
}

/** Both ends of a 3D line, out of all of them. */
export function endsOf(lines: Float64Array, index: number): number[] {
  return [...lines.subarray(index * LINE_STRIDE, (index + 1) * LINE_STRIDE)];
}

/** The sides of closed rings, as `strokes` takes them. */
export function sidesOf(rings: readonly (readonly Vec3[])[]): number[] {
  return rings.flatMap((ring) => edgesOf(ring).flat(2));
}

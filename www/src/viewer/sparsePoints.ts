/** World points of an orientation with the colours of their photographs. */
import { BufferAttribute, BufferGeometry, Color, Points, PointsMaterial, Vector3 } from "three";
import { yUp, zUpGroup } from "./scene/frame";
import { type Layer, layerOf } from "./scene/layer";

const SIZE_PX = 2.5;

/**
 * @param points x, y, z of each, local frame, metres
 * @param colours red, green, blue of each, 0 to 255
 */
export function buildSparsePoints(points: Float32Array, colours: Uint8Array): Layer {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  const linear = new Float32Array(colours.length);
  const colour = new Color();
  for (let i = 0; i + 2 < colours.length; i += 3) {
    colour.setRGB(channel(colours, i), channel(colours, i + 1), channel(colours, i + 2), "srgb");
    colour.toArray(linear, i);
  }
  geometry.setAttribute("color", new BufferAttribute(linear, 3));
  const material = new PointsMaterial({ size: SIZE_PX, sizeAttenuation: false, vertexColors: true });
  const object = zUpGroup();
  object.add(new Points(geometry, material));
  return layerOf(object);
}

function channel(colours: Uint8Array, at: number): number {
  return (colours[at] ?? 0) / 255;
}

/** Most points of which the middle and the extent are taken. */
const SAMPLED = 4000;

/** Points without the farthest ones, in the viewer's frame, and the height of their middle, local frame. */
export function usualPoints(points: Float32Array): { corners: Vector3[]; middle: Vector3 } {
  const count = Math.floor(points.length / 3);
  const step = Math.max(1, Math.floor(count / SAMPLED));
  const sampled = Array.from({ length: Math.floor(count / step) }, (_, i) => 3 * i * step);
  const ranges = [0, 1, 2].map((axis) => {
    const values = Float64Array.from(sampled, (at) => points[at + axis] as number).sort();
    const at = (share: number) => values[Math.floor(share * (values.length - 1))] ?? 0;
    return { low: at(0.03), middle: at(0.5), high: at(0.97) };
  });
  const of = (kind: "low" | "middle" | "high") =>
    ranges.map((range) => range[kind]) as [number, number, number];
  return { corners: [yUp(of("low")), yUp(of("high"))], middle: new Vector3(...of("middle")) };
}

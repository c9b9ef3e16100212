/** The smallest GLB that shows facets: one mesh each, unlit grey, with the extras that the viewer reads. */
import type { Facet, Vec3 } from "../../src/shared/records";

const GLB_MAGIC = 0x46546c67;
const CHUNK_JSON = 0x4e4f534a;
const CHUNK_BIN = 0x004e4942;

export function glbOf(facets: readonly Facet[]): Uint8Array<ArrayBuffer> {
  const positions = facets.map(({ outer }) => fan(outer).flatMap(([x, y, z]) => [x, z, -y]));
  const json = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: facets.map((_, i) => i) }],
    nodes: facets.map(({ building }, i) => ({ mesh: i, extras: { building, facet: i, surface: "roof" } })),
    meshes: facets.map((_, i) => ({ primitives: [{ attributes: { POSITION: i }, material: 0 }] })),
    materials: [{ doubleSided: true, pbrMetallicRoughness: { baseColorFactor: [0.8, 0.5, 0.4, 1] } }],
    accessors: positions.map((list, i) => accessor(list, i)),
    bufferViews: positions.map((list, i) => ({
      buffer: 0,
      byteOffset: 4 * positions.slice(0, i).flat().length,
      byteLength: 4 * list.length,
    })),
    buffers: [{ byteLength: 4 * positions.flat().length }],
  };
  return pack(JSON.stringify(json), Float32Array.from(positions.flat()));
}

function fan(ring: readonly Vec3[]): Vec3[] {
  const triangles: Vec3[] = [];
  for (let i = 1; i + 1 < ring.length; i += 1) {
    triangles.push(ring[0] as Vec3, ring[i] as Vec3, ring[i + 1] as Vec3);
  }
  return triangles;
}

function accessor(list: number[], bufferView: number): object {
  const axis = (k: number) => list.filter((_, i) => i % 3 === k).map(Math.fround);
  return {
    bufferView,
    componentType: 5126,
    count: list.length / 3,
    type: "VEC3",
    min: [0, 1, 2].map((k) => Math.min(...axis(k))),
    max: [0, 1, 2].map((k) => Math.max(...axis(k))),
  };
}

function pack(json: string, data: Float32Array): Uint8Array<ArrayBuffer> {
  const text = new TextEncoder().encode(json.padEnd(Math.ceil(json.length / 4) * 4));
  const bytes = new Uint8Array(28 + text.length + data.byteLength);
  const header = new DataView(bytes.buffer);
  [GLB_MAGIC, 2, bytes.length, text.length, CHUNK_JSON].forEach((value, i) => {
    header.setUint32(4 * i, value, true);
  });
  bytes.set(text, 20);
  header.setUint32(20 + text.length, data.byteLength, true);
  header.setUint32(24 + text.length, CHUNK_BIN, true);
  bytes.set(new Uint8Array(data.buffer), 28 + text.length);
  return bytes;
}

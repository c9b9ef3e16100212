/** The ground around the buildings, as the photographs show it. */
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  SRGBColorSpace,
  Vector3,
} from "three";
import type { GroundTexture } from "../../shared/calls";
import { zUpGroup } from "../../viewer/scene/frame";
import { BOTH_SIDES, type Layer, layerOf } from "../../viewer/scene/layer";

export function buildGround({ about, rgba }: GroundTexture): Layer {
  const geometry = new BufferGeometry().setFromPoints(about.corners.map((corner) => new Vector3(...corner)));
  geometry.setAttribute("uv", new BufferAttribute(Float32Array.from([0, 0, 1, 0, 1, 1, 0, 1]), 2));
  geometry.setIndex([0, 3, 2, 0, 2, 1]);
  const texture = new DataTexture(rgba, about.width, about.height);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  const material = new MeshBasicMaterial({
    map: texture,
    ...BOTH_SIDES,
    transparent: true,
    // Walls end at the ground: where they meet, the wall is in front.
    polygonOffset: true,
    polygonOffsetFactor: 2,
    polygonOffsetUnits: 2,
  });
  const mesh = new Mesh(geometry, material);
  const object = zUpGroup();
  object.add(mesh);
  return layerOf(object);
}

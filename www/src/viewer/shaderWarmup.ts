/** What tools and the model need, one thing each, never shown: its shaders are made when the page opens. */
import { Mesh, MeshBasicMaterial, Sphere, SphereGeometry, Texture, Vector3 } from "three";
import { PALETTE } from "../shared/palette";
import { edgeLines } from "./layers/model";
import { buildGrid } from "./scene/grid";
import { type Layer, layerOf } from "./scene/layer";

export function warmupLayers(): Layer[] {
  return [
    buildGrid(new Sphere(new Vector3(), 1), 0, PALETTE.unmatched),
    layerOf(edgeLines([0, 0, 0, 1, 0, 0])),
    layerOf(new Mesh(new SphereGeometry(), new MeshBasicMaterial({ map: new Texture() }))),
  ];
}

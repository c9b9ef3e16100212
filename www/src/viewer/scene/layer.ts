/** What every builder of the viewer returns: an object, what a click on it means, and its end. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  HemisphereLight,
  type Intersection,
  type Material,
  Mesh,
  MeshBasicMaterial,
  type MeshBasicMaterialParameters,
  type Object3D,
  Texture,
  Vector3,
} from "three";
import type { Selection } from "../../shared/selection";

export interface Layer {
  /** In the viewer's frame, Y up. */
  object: Object3D;
  /** What was hit, where the object can be picked. */
  pick(hit: Intersection): Selection | null;
  /** Shows the selection, if it is one of this layer's things; otherwise none. */
  highlight(selection: Selection | null): void;
  dispose(): void;
}

/** A layer of an object: for looking at only, as far as nothing else is said. */
export function layerOf(object: Object3D, of: Partial<Omit<Layer, "object">> = {}): Layer {
  return {
    object,
    pick: () => null,
    highlight: () => undefined,
    dispose: () => disposeObject(object),
    ...of,
  };
}

/** The light of all scenes: the sky's, and a sun's from above. */
export function daylight(): [HemisphereLight, DirectionalLight] {
  const sun = new DirectionalLight(0xffffff, 2.2);
  sun.position.set(-0.6, 1, 0.5);
  return [new HemisphereLight(0xffffff, 0x8a8580, 1.4), sun];
}

/** The layer for looking at only: a selection is not of its things. */
export function unpicked({ object, dispose }: Pick<Layer, "object" | "dispose">): Layer {
  return layerOf(object, { dispose });
}

/** Behind lines that lie in it: else the two would fight for each pixel. */
export const BEHIND_LINES = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 } as const;

/** Seen from both sides by one shader: what is transparent would be drawn in two passes, each with its own. */
export const BOTH_SIDES = { side: DoubleSide, forceSinglePass: true } as const;

/** Frees the GPU memory of an object and of all below it. */
export function disposeObject(root: Object3D): void {
  root.traverse((object) => {
    const { geometry, material } = object as Partial<Mesh>;
    if (geometry instanceof BufferGeometry) {
      geometry.dispose();
    }
    for (const one of Array.isArray(material) ? material : [material]) {
      disposeMaterial(one);
    }
  });
}

function disposeMaterial(material: Material | undefined): void {
  if (material === undefined) {
    return;
  }
  for (const value of Object.values(material)) {
    if (value instanceof Texture) {
      value.dispose();
    }
  }
  material.dispose();
}

/**
 * Triangles in colours of their own, see-through.
 * @param positions three numbers a corner
 * @param colours four numbers a corner, with its opacity
 * @param corners of each triangle; without them the positions are in their order
 */
export function colouredMesh(
  positions: ArrayLike<number>,
  colours: ArrayLike<number>,
  corners: number[] | null,
  style: MeshBasicMaterialParameters = {},
): Mesh<BufferGeometry, MeshBasicMaterial> {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(positions), 3));
  geometry.setAttribute("color", new BufferAttribute(Float32Array.from(colours), 4));
  geometry.setIndex(corners);
  return new Mesh(
    geometry,
    new MeshBasicMaterial({ vertexColors: true, ...BOTH_SIDES, transparent: true, ...style }),
  );
}

/** The corners of each triangle of a mesh, in its own frame. */
export function trianglesOf(geometry: BufferGeometry): [Vector3, Vector3, Vector3][] {
  const positions = geometry.getAttribute("position");
  const count = Math.floor((geometry.index?.count ?? positions.count) / 3);
  const corner = (i: number) => new Vector3().fromBufferAttribute(positions, geometry.index?.getX(i) ?? i);
  return Array.from({ length: count }, (_, i) => [corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)]);
}

/** The corners of the triangles of so many figures of four corners, one after the other. */
export function quads(count: number): number[] {
  return Array.from({ length: count }, (_, i) => [0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner)).flat();
}

/** A colour's components as the vertex attributes of a geometry want them. */
export function rgb(colour: string): [number, number, number] {
  return new Color(colour).toArray() as [number, number, number];
}

/** The one object of a layer that shows what is selected: unpickable, and made anew with every selection. */
export class SelectedObject {
  #shown: Object3D | null = null;
  readonly #parent: Object3D;

  constructor(parent: Object3D) {
    this.#parent = parent;
  }

  show(object: Object3D | null): void {
    if (this.#shown !== null) {
      this.#parent.remove(this.#shown);
      disposeObject(this.#shown);
    }
    this.#shown = object;
    if (object !== null) {
      object.traverse((one) => {
        one.raycast = () => undefined;
      });
      this.#parent.add(object);
    }
  }
}

/** What every builder of the viewer returns: an object, what a click on it means, and its end. */
import {
  BufferGeometry,
  Color,
  DoubleSide,
  type Intersection,
  type Material,
  type Mesh,
  type Object3D,
  Texture,
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

/** The layer for looking at only: a selection is not of its things. */
export function unpicked({ object, dispose }: Pick<Layer, "object" | "dispose">): Layer {
  return { object, pick: () => null, highlight: () => undefined, dispose };
}

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

/** A colour's components as the vertex attributes of a geometry want them. */
export function rgb(colour: string): [number, number, number] {
  return new Color(colour).toArray() as [number, number, number];
}

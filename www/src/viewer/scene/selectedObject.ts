/** The one object of a layer that shows what is selected: unpickable, and made anew with every selection. */
import type { Object3D } from "three";
import { disposeObject } from "./layer";

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

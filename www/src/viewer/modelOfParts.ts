/** The models of several tiles as one layer, as long as they are not joined. */
import { Group } from "three";
import type { ModelLayer } from "./layers/model";

/** The parts stay what they are: the layer of more of them takes the same ones over, and they end with the last. */
export function modelOfParts(parts: readonly ModelLayer[]): ModelLayer {
  const object = new Group();
  for (const part of parts) {
    object.add(part.object);
  }
  return {
    object,
    // Numbers of facets and buildings are those of a tile: nothing else knows them.
    pick: () => null,
    highlight: () => undefined,
    setMode: (mode) => parts.forEach((part) => void part.setMode(mode)),
    setFacetColours: () => undefined,
    setTheme: (colours) => parts.forEach((part) => void part.setTheme(colours)),
    showObstructions: (shows) => parts.forEach((part) => void part.showObstructions(shows)),
    dispose() {
      for (const part of parts.filter((one) => one.object.parent === object)) {
        part.dispose();
      }
    },
  };
}

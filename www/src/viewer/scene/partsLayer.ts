/** Layers of many things of one kind, drawn in few parts: a click picks the thing whose piece it hits. */
import type { Intersection, Material, Object3D } from "three";
import { type IndexedKind, pickedIndex, type Selection } from "../../shared/selection";
import { zUpGroup } from "./frame";
import { type Layer, layerOf, SelectedObject } from "./layer";

export interface Part {
  drawn: Object3D & { material: Material };
  /** By itself, and while something is selected. */
  opacity?: readonly [alone: number, dimmed: number];
  /** The thing of each piece; a part without them is not of any. */
  things?: readonly number[];
  /** Of how many faces a piece is. */
  facesEach?: number;
  /** What a click on it means, where that is no thing of the layer's kind. */
  pick?(hit: Intersection): Selection | null;
}

const SOLID = [1, 1] as const;

interface Parts {
  kind: IndexedKind;
  parts: readonly Part[];
  /** What is drawn with them. */
  beside?: readonly Object3D[];
  /** Shows what is selected, by its place among the things of the kind; -1 where it is none of them. */
  chosen?(index: number, selection: Selection | null): Object3D | null;
}

/** Of parts in the local frame. */
export function partsLayer({ kind, parts, beside = [], chosen = () => null }: Parts): Layer {
  const object = zUpGroup();
  for (const one of [...parts.map(({ drawn }) => drawn), ...beside]) {
    object.add(one);
  }
  const shown = new SelectedObject(object);
  const fade = (state: 0 | 1) => {
    for (const { drawn, opacity = SOLID } of parts) {
      drawn.material.opacity = opacity[state];
    }
  };
  fade(0);
  return layerOf(object, {
    pick: (hit) => {
      const part = parts.find(({ drawn }) => drawn === hit.object);
      if (part?.pick !== undefined) {
        return part.pick(hit);
      }
      const index = part?.things?.[Math.floor((hit.faceIndex ?? -1) / (part.facesEach ?? 1))] ?? -1;
      return index < 0 ? null : { kind, index };
    },
    highlight: (selection) => {
      fade(selection === null ? 0 : 1);
      shown.show(chosen(pickedIndex(selection, kind), selection));
    },
  });
}

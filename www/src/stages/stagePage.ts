/**
 * What only the page has of a stage: layers in space, and switches above the view; `<name>/page.tsx`, gathered in `pages.ts`. A
 * stage without layers that are shown first is seen in the photographs.
 */
import type { ComponentType } from "preact";
import { results } from "../app/state/results";
import type { Vec3 } from "../shared/records";
import type { Layer } from "../viewer/scene/layer";
import type { Results } from "./list";

export interface StagePage {
  layers?: Readonly<Record<string, SpaceLayer>>;
  /** The layers that its tab shows until a person switches something. */
  shows?: readonly string[];
  /** Whether there is nothing yet that its tab could show. */
  isEmpty?(results: Results): boolean;
  /** What its tab alone switches. */
  Switch?: ComponentType;
}

export interface SpaceLayer {
  /** On its switch; a layer without one follows other switches. */
  title?: string;
  /** What it shows now, of the page's state; the model is read from its file instead. */
  plan?(now: LayerState): Plan;
  /** Whether it is seen, where its switch alone does not say so. */
  isSeen?(isChosen: boolean): boolean;
  /** When a click tries it, among the others: thin things first, what is over them before. Without one it is not picked. */
  pickOrder?: number;
  /** Whether its points can be measured. */
  isMeasured?: boolean;
  /** Whether a cut goes through it. */
  isCut?: boolean;
  /** How it looks, and what its colours mean, while it is shown. */
  Switch?: ComponentType;
  Legend?: ComponentType;
  /** One thing of it, never shown: its shaders are made when the page opens, and not beside the running pipeline. */
  warm?(): Layer;
}

export interface LayerState {
  /** Whether its switch is on in the present tab: what is large is built once somebody looks. */
  isChosen: boolean;
  /** Where cameras look at, local frame. */
  middle(): Vec3;
}

/** A function that makes a layer, and what it makes it of; null where there is nothing to show. */
export type Plan = readonly [build: () => Layer, ...of: unknown[]] | null;

type Present<Parts extends readonly unknown[]> = { [K in keyof Parts]: NonNullable<Parts[K]> };

/** The plan of a layer that is made of parts of the results, once all of them are there. */
export function planOf<const Parts extends readonly unknown[]>(
  partsOf: (found: Results) => Parts,
  build: (...parts: Present<Parts>) => Layer,
): () => Plan {
  return () => {
    const parts = partsOf(results.value);
    return parts.includes(null) ? null : [() => build(...(parts as Present<Parts>)), ...parts];
  };
}

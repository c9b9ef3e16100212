/** The corrections of the model, done and undone: data among the parameters, which the core applies as a stage. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { ParamGroup } from "../../../shared/paramTree";
import type { Correction, Vec3 } from "../../../shared/records";
import { runTo, setParam } from "../../session/stageRuns";
import { params } from "../../state/parameters";
import { mainResults } from "../../state/results";
import { scene } from "../../state/scene";
import { stages } from "../../state/stages";
import { select } from "../../state/viewState";
import { difference, facetAt } from "./facetGeometry";

type List = readonly Correction[];

export const corrections: ReadonlySignal<List> = computed(
  () => (params.value["corrections"] ?? []) as unknown as List,
);

/** The lists before the present one and after it, and which one they are about: another project has another past. */
const past = signal<readonly List[]>([]);
const future = signal<readonly List[]>([]);
let about: string | null = null;

const isPresent = (list: List) => about === JSON.stringify(list);
export const canUndo = computed(() => past.value.length > 0 && isPresent(corrections.value));
export const canRedo = computed(() => future.value.length > 0 && isPresent(corrections.value));

/** Adds a correction, and looks on at the facet at a place, world frame. */
export function correct(correction: Correction, lookAt: Vec3 | null = null): Promise<void> {
  return change([...corrections.value, correction], lookAt);
}

export function remove(index: number): Promise<void> {
  return change(
    corrections.value.filter((_, i) => i !== index),
    null,
  );
}

/** Takes another list in place of the present one. */
export function change(next: List, lookAt: Vec3 | null): Promise<void> {
  past.value = [...(canUndo.value ? past.value : []), corrections.value];
  future.value = [];
  return apply(next, lookAt);
}

export async function undo(): Promise<void> {
  const before = past.value.at(-1);
  if (canUndo.value && before !== undefined) {
    past.value = past.value.slice(0, -1);
    future.value = [...future.value, corrections.value];
    await apply(before, null);
  }
}

export async function redo(): Promise<void> {
  const after = future.value.at(-1);
  if (canRedo.value && after !== undefined) {
    future.value = future.value.slice(0, -1);
    past.value = [...past.value, corrections.value];
    await apply(after, null);
  }
}

async function apply(next: List, lookAt: Vec3 | null): Promise<void> {
  about = JSON.stringify(next);
  setParam("corrections", next as unknown as ParamGroup);
  const last = stages.value.at(-1);
  if (last !== undefined) {
    await runTo(last.name);
  }
  const facets = mainResults.value.facets;
  const origin = scene.value?.origin;
  if (lookAt !== null && facets !== null && origin !== undefined) {
    const index = facetAt(facets, difference(lookAt, origin));
    select(index < 0 ? null : { kind: "facet", index });
  }
}

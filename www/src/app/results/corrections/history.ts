/** The corrections of the model: data among the parameters, which the core applies as a stage; a step each. */
import { computed, type ReadonlySignal } from "@preact/signals";
import { sub } from "../../../shared/linear";
import type { ParamGroup } from "../../../shared/paramTree";
import type { Correction, Vec3 } from "../../../shared/records";
import { runTo, setParam } from "../../session/stageRuns";
import { type Step, steps, undoneSteps } from "../../session/steps";
import { params } from "../../state/parameters";
import { mainResults } from "../../state/results";
import { scene } from "../../state/scene";
import { stages } from "../../state/stages";
import { select } from "../../state/viewState";
import { correctionWords } from "./correctionWords";
import { facetAt } from "./facetGeometry";

type List = readonly Correction[];

export const corrections: ReadonlySignal<List> = computed(
  () => (params.value["corrections"] ?? []) as unknown as List,
);

const isCorrection = (step: Step | undefined) => step?.about === "corrections";
/** Whether the last step, or the one that was taken back last, is a correction. */
export const canUndo = computed(() => isCorrection(steps.value.at(-1)));
export const canRedo = computed(() => isCorrection(undoneSteps.value.at(-1)));

/** Adds a correction, and looks on at the facet at a place, world frame. */
export function correct(correction: Correction, lookAt: Vec3 | null = null): Promise<void> {
  return change([...corrections.value, correction], correctionWords(correction), lookAt);
}

export function remove(index: number): Promise<void> {
  const left = corrections.value.filter((_, i) => i !== index);
  return change(left, `Correction ${index + 1} removed`);
}

/** Takes another list in place of the present one, as a step with these words. */
export async function change(next: List, what: string, lookAt: Vec3 | null = null): Promise<void> {
  setParam("corrections", next as unknown as ParamGroup, what);
  const last = stages.value.at(-1);
  if (last !== undefined) {
    await runTo(last.name);
  }
  const facets = mainResults.value.facets;
  const origin = scene.value?.origin;
  if (lookAt !== null && facets !== null && origin !== undefined) {
    const index = facetAt(facets, sub(lookAt, origin));
    select(index < 0 ? null : { kind: "facet", index });
  }
}

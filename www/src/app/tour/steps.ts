/** The guided tour through the stages on the demo scene: B99 as a whole, its other ways to planes, and W96 at the end. */
import { METHODS, type Method, STAGES } from "../../shared/stages";
import { mainTabOf, methodOfStage } from "../../stages/catalogue";
import type { Tab } from "../../stages/list";
import type { StageStep } from "../../stages/tourStep";
import { openDemoIn } from "../project/projectActions";
import type { Turn } from "../session/actionQueue";
import { actions } from "../session/session";
import { chooseMethod, runEverything } from "../session/stageRuns";
import { method } from "../state/parameters";
import { files, isDemo } from "../state/project";
import { freshStages, stages } from "../state/stages";
import { showTourStep, tourStep } from "../state/tour";
import { select, showFace, showTab } from "../state/viewState";

interface TourStep extends StageStep {
  method: Method;
  tab: Tab;
}

const found = import.meta.glob<readonly StageStep[]>("../../stages/*/tour.ts", {
  eager: true,
  import: "default",
});

/** By method, and in each in the order of the stages. */
export const STEPS: readonly TourStep[] = STAGES.flatMap(({ name, section }) => {
  const own = { method: methodOfStage(name), tab: mainTabOf(name), isLast: section.startsWith("W96") };
  return (found[`../../stages/${name}/tour.ts`] ?? []).map((step) => ({ ...step, ...own }));
}).sort(
  (a, b) => Number(a.isLast) - Number(b.isLast) || METHODS.indexOf(a.method) - METHODS.indexOf(b.method),
);

export function startTour(): void {
  void goTo(0);
}

export function endTour(): void {
  showTourStep(null);
}

/** Opens a step: its method run to the end on the demo scene, its view, and what it is about. */
export async function goTo(step: number): Promise<void> {
  if (STEPS[step] === undefined) {
    endTour();
    return;
  }
  showTourStep(step);
  showFace("method");
  await actions.perform({ kind: "tour", name: "step", phase: "load" }, async (turn) => {
    // Steps that were passed while this one waited need no run of their own.
    await goToIn(turn, tourStep.value ?? step);
  });
}

/** The same as part of another action. */
export async function goToIn(turn: Turn, step: number): Promise<void> {
  const shown = STEPS[step];
  if (shown === undefined) {
    return;
  }
  showTourStep(step);
  showFace("method");
  if (files.value.length === 0) {
    await openDemoIn(turn, null);
  }
  if (method.value !== shown.method) {
    chooseMethod(shown.method);
  }
  if (freshStages.value < stages.value.length) {
    await runEverything(turn);
  }
  if (tourStep.value === step) {
    select(null);
    showTab(shown.tab);
    shown.prepare?.();
  }
}

/** Whether the tour runs on the scene that it was written for. */
export function isOnDemo(): boolean {
  return files.value.length === 0 || isDemo.value;
}

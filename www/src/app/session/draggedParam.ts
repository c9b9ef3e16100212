/**
 * A parameter that is dragged: the stage that reads it first is run again with every value, from what the core holds of the
 * stages before it; those behind it follow once the parameter is let go.
 */
import type { StageName } from "../../shared/stages";
import { firstStageOf } from "../../stages/catalogue";
import { stages } from "../state/stages";
import { changeParam, runAll, runTo, setParam } from "./stageRuns";

/** The parameter that is being dragged: all its values together are one step. */
let dragged = "";

/** Sets the parameter at a path of names. Where its stage has run, that runs again; while it does, the last value waits. */
export function dragParam(path: string, value: number): void {
  const names = stages.value.map(({ name }) => name);
  const touched = stages.value[firstStageOf(path, names)];
  (path === dragged ? changeParam : setParam)(path, value);
  dragged = path;
  if (touched !== undefined && hasRun(touched.status)) {
    void runTo(touched.name);
  }
}

/** The parameter is let go: where all stages had run, they do again. */
export async function dropParam(path: string): Promise<void> {
  dragged = "";
  const names = stages.value.map(({ name }) => name);
  const touched: StageName | undefined = names[firstStageOf(path, names)];
  const last = stages.value.at(-1);
  if (touched !== undefined && last?.status === "outdated") {
    await runTo(touched);
    await runAll();
  }
}

function hasRun(status: string): boolean {
  return status === "done" || status === "outdated" || status === "running";
}

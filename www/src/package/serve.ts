/** The worker's side of the package: parse, run every stage, export. No state between requests. */
import type { Session } from "../pkg/ridgeline.js";
import type { Progress, Reconstruction, Reply, Request } from "./client.js";

/** Progress is told in steps of a hundredth at least: stages report much more often. */
const PROGRESS_STEP = 0.01;

/** Answers one request. */
export function answer(session: Session, request: Request, post: (reply: Reply) => void): void {
  try {
    post({ type: "done", result: reconstruct(session, request, post) });
  } catch (error) {
    const isInput = error instanceof Error && error.name === "InputError";
    post({ type: "failed", isInput, message: error instanceof Error ? error.message : String(error) });
  }
}

function reconstruct(session: Session, request: Request, post: (reply: Reply) => void): Reconstruction {
  let last: Progress = { stage: "", fraction: 0 };
  const report = (stage: string, fraction: number): void => {
    const isNews = stage !== last.stage || fraction >= last.fraction + PROGRESS_STEP;
    if (!isNews && fraction < 1) return;
    last = { stage, fraction };
    post({ type: "progress", progress: last });
  };
  session.clearFiles();
  for (const { path, bytes } of request.files) session.addFile(path, bytes);
  // The core fills in what is left out.
  session.setParams(request.params);
  report("load", 0);
  const scene = session.load(request.load);
  report("load", 1);
  const stages = session
    .chosenStages()
    .map((stage) => session.runStage(stage, (fraction: number) => report(stage, fraction)));
  if (request.setbacks !== undefined) session.reportWith(request.setbacks);
  const names = session.exportNames();
  return {
    scene,
    stages,
    facets: session.facets(),
    files: new Map(names.map((name) => [name, session.exportFile(name)])),
  };
}

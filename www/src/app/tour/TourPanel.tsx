/** The present step of the guided tour: what is seen, a question, and whether the answer was found. */
import "./tour.css";
import { signal, useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { isBusy } from "../state/activity";
import { tourStep } from "../state/tour";
import { endTour, goTo, isOnDemo, STEPS } from "./steps";

/** What was said of the steps whose answer was found once: it does not go away again. */
const found = signal<ReadonlyMap<number, string>>(new Map());

export function TourPanel() {
  useSignalEffect(() => {
    const step = tourStep.value;
    const now = STEPS[step ?? -1];
    if (step !== null && !isBusy.value && now?.isFound() === true && !found.peek().has(step)) {
      found.value = new Map([...found.peek(), [step, now.answer()]]);
    }
  });
  const step = tourStep.value ?? 0;
  const shown = STEPS[step];
  const mark = shown?.pointsTo;
  useEffect(() => {
    if (mark === undefined) {
      return undefined;
    }
    document.body.dataset["pointsTo"] = mark;
    return () => {
      delete document.body.dataset["pointsTo"];
    };
  }, [mark]);
  if (shown === undefined) {
    return null;
  }
  const answer = found.value.get(step);
  const isFound = answer !== undefined;
  return (
    <section class="panel tour-step" aria-label="Guided tour" data-testid="tour-step">
      <div class="row spread">
        <span class="muted numbers">
          Step {step + 1} of {STEPS.length}
        </span>
        <button type="button" class="quiet" onClick={endTour}>
          End tour
        </button>
      </div>
      <h2>{shown.title}</h2>
      <p>{shown.text}</p>
      <p class="question">{shown.question}</p>
      <p class={`answer ${isFound ? "found" : ""}`} role="status">
        {isFound
          ? `✓ ${answer}`
          : isBusy.value
            ? "The scene is being reconstructed…"
            : (shown.hint?.() ?? "Not found yet.")}
      </p>
      {!isOnDemo() && (
        <p class="muted">The tour was written for the demo scene; on other scenes its answers may differ.</p>
      )}
      <div class="row">
        <button type="button" disabled={step === 0} onClick={() => void goTo(step - 1)}>
          Back
        </button>
        <button type="button" class={isFound ? "primary" : ""} onClick={() => void goTo(step + 1)}>
          {step + 1 === STEPS.length ? "Finish" : "Next"}
        </button>
      </div>
      <ol class="steps" aria-hidden="true">
        {STEPS.map(({ title }, i) => (
          <li key={title} class={`${i === step ? "now" : ""} ${found.value.has(i) ? "done" : ""}`} />
        ))}
      </ol>
    </section>
  );
}

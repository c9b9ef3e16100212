/** The present step of the guided tour: what is seen, a question, and whether the answer was found. */
import "./tour.css";
import { signal, useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { isBusy } from "../state/activity";
import { lessonStep } from "../state/tour";
import { endTour, goTo, isOnDemo, LESSONS } from "./lessons";

/** What was said of the steps whose answer was found once: it does not go away again. */
const found = signal<ReadonlyMap<number, string>>(new Map());

export function Lesson() {
  useSignalEffect(() => {
    const step = lessonStep.value;
    const now = LESSONS[step ?? -1];
    if (step !== null && !isBusy.value && now?.isFound() === true && !found.peek().has(step)) {
      found.value = new Map([...found.peek(), [step, now.answer()]]);
    }
  });
  const step = lessonStep.value ?? 0;
  const lesson = LESSONS[step];
  const mark = lesson?.pointsTo;
  useEffect(() => {
    if (mark === undefined) {
      return undefined;
    }
    document.body.dataset["pointsTo"] = mark;
    return () => {
      delete document.body.dataset["pointsTo"];
    };
  }, [mark]);
  if (lesson === undefined) {
    return null;
  }
  const answer = found.value.get(step);
  const isFound = answer !== undefined;
  return (
    <section class="panel lesson" aria-label="Guided tour" data-testid="lesson">
      <div class="row spread">
        <span class="muted numbers">
          Step {step + 1} of {LESSONS.length}
        </span>
        <button type="button" class="quiet" onClick={endTour}>
          End tour
        </button>
      </div>
      <h2>{lesson.title}</h2>
      <p>{lesson.text}</p>
      <p class="question">{lesson.question}</p>
      <p class={`answer ${isFound ? "found" : ""}`} role="status">
        {isFound
          ? `✓ ${answer}`
          : isBusy.value
            ? "The scene is being reconstructed…"
            : (lesson.hint?.() ?? "Not found yet.")}
      </p>
      {!isOnDemo() && (
        <p class="muted">The tour was written for the demo scene; on other scenes its answers may differ.</p>
      )}
      <div class="row">
        <button type="button" disabled={step === 0} onClick={() => void goTo(step - 1)}>
          Back
        </button>
        <button type="button" class={isFound ? "primary" : ""} onClick={() => void goTo(step + 1)}>
          {step + 1 === LESSONS.length ? "Finish" : "Next"}
        </button>
      </div>
      <ol class="steps" aria-hidden="true">
        {LESSONS.map(({ title }, i) => (
          <li key={title} class={`${i === step ? "now" : ""} ${found.value.has(i) ? "done" : ""}`} />
        ))}
      </ol>
    </section>
  );
}

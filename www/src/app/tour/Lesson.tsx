/** The present step of the guided tour: what is seen, a question, and whether the answer was found. */
import "./tour.css";
import { signal, useSignalEffect } from "@preact/signals";
import { isBusy } from "../state/activity";
import { lessonStep } from "../state/tour";
import { endTour, goTo, isOnDemo, LESSONS } from "./lessons";

/** Steps whose answer was found once: it does not go away again. */
const found = signal<ReadonlySet<number>>(new Set());

export function Lesson() {
  useSignalEffect(() => {
    const step = lessonStep.value;
    if (step !== null && !isBusy.value && LESSONS[step]?.isFound() === true && !found.peek().has(step)) {
      found.value = new Set([...found.peek(), step]);
    }
  });
  const step = lessonStep.value ?? 0;
  const lesson = LESSONS[step];
  if (lesson === undefined) {
    return null;
  }
  const isFound = found.value.has(step);
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
          ? `✓ ${lesson.answer}`
          : isBusy.value
            ? "The scene is being reconstructed…"
            : "Not found yet."}
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

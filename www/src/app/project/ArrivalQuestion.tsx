/** The question that files ask which come while a project is open. */
import "./project.css";
import { useEffect, useRef, useState } from "preact/hooks";
import { projectName } from "../state/project";
import { answerArrival, arrived, askAgain, type Choice, chosenForVisit } from "./arrivals";

export function ArrivalQuestion() {
  const added = arrived.value;
  return added === null ? null : <Question count={added.length} />;
}

function Question({ count }: { count: number }) {
  const dialog = useRef<HTMLDialogElement>(null);
  const [forVisit, setForVisit] = useState(true);
  useEffect(() => dialog.current?.showModal(), []);
  const answer = (choice: Choice | null) => () => void answerArrival(choice, forVisit);
  return (
    <dialog ref={dialog} class="arrival" aria-labelledby="arrival-title" onCancel={answer(null)}>
      <h2 id="arrival-title">
        {count} {count === 1 ? "file" : "files"}: a new project?
      </h2>
      <p>
        “{projectName}” is open. A new project takes its place; otherwise the files are added to it, and those
        of the same name replaced.
      </p>
      <label class="option-check">
        <input
          type="checkbox"
          checked={forVisit}
          onChange={(event) => setForVisit(event.currentTarget.checked)}
        />
        Do the same for the rest of this visit
      </label>
      <div class="row">
        <button type="button" class="primary" onClick={answer("open")}>
          New project
        </button>
        <button type="button" onClick={answer("add")}>
          Add to this one
        </button>
        <button type="button" class="quiet" onClick={answer(null)}>
          Cancel
        </button>
      </div>
    </dialog>
  );
}

/** What was chosen for the visit, and how to be asked again. */
export function ArrivalHabit() {
  const choice = chosenForVisit.value;
  if (choice === null) {
    return null;
  }
  return (
    <p class="kept muted">
      <span>{choice === "open" ? "They begin a new project." : "They are added to this project."}</span>
      <button type="button" class="quiet" onClick={askAgain}>
        Ask again
      </button>
    </p>
  );
}

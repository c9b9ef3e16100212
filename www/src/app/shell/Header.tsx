/** One row: the project, the two faces of the page, what is going on, and what can be done with the result. */

import { Choice } from "../parts/Choice";
import { LookButtons } from "../parts/LookButtons";
import { Menu } from "../parts/Menu";
import { redo, undo } from "../project/projectActions";
import { steps, undoneSteps } from "../session/steps";
import { activity } from "../state/activity";
import { projectName } from "../state/project";
import { type Face, face, showFace } from "../state/viewState";
import { startTour } from "../tour/steps";
import { ResultActions } from "../view/result/ResultActions";
import { isPhone, layout } from "../view/screen/layout";
import { showsWorkbench } from "../view/screen/opening";
import { openPanel, shownPanel } from "../view/screen/panels";

export function Header() {
  const isOpen = showsWorkbench.value;
  return (
    <header class="header">
      <img src="./icon.svg" alt="" width="22" height="22" />
      <h1>ridgeline</h1>
      {isOpen && (
        <>
          <ProjectButton />
          <FaceSwitch />
          <Steps />
        </>
      )}
      <span class="grow" />
      {activity.value !== "" && (
        <span class="activity">
          <span class="spinner" aria-hidden="true" />
          {activity}
        </span>
      )}
      {isOpen && face.value === "result" && <ResultActions />}
      {isOpen && layout.value !== "wide" ? (
        <Menu title="⋯" label="More" class="more">
          <More />
        </Menu>
      ) : (
        <More />
      )}
    </header>
  );
}

function More() {
  return (
    <>
      <button type="button" class="quiet" onClick={startTour}>
        Tour
      </button>
      <a class="button quiet" href="./lessons.html">
        Lessons
      </a>
      <LookButtons />
    </>
  );
}

/** The project's name opens its files. */
function ProjectButton() {
  const isShown = shownPanel.value === "project";
  const title = isPhone.value ? "Project" : projectName.value || "Project";
  return (
    <button
      type="button"
      class="quiet project-button"
      aria-label={`Project: ${projectName.value}`}
      aria-expanded={isShown}
      onClick={() => openPanel(isShown ? "main" : "project")}
    >
      {title}
    </button>
  );
}

/** What was done in this visit, the last step first. */
function Steps() {
  const [done, undone] = [steps.value, undoneSteps.value];
  if (isPhone.value || done.length + undone.length === 0) {
    return null;
  }
  return (
    <Menu title="↶" label="Steps" class="steps-menu">
      <div class="row">
        <button type="button" disabled={done.length === 0} title="Ctrl+Z" onClick={() => void undo()}>
          Undo
        </button>
        <button type="button" disabled={undone.length === 0} title="Ctrl+Shift+Z" onClick={() => void redo()}>
          Redo
        </button>
      </div>
      <ol aria-label="Steps, the last one first">
        {undone.map(({ what }, i) => (
          <li key={`${i} ${what}`} class="muted">
            {what} <i>(taken back)</i>
          </li>
        ))}
        {[...done].reverse().map(({ what }, i) => (
          <li key={done.length - i}>{what}</li>
        ))}
      </ol>
    </Menu>
  );
}

const FACES: readonly (readonly [Face, string, string])[] = [
  ["result", "Result", "The model, its buildings, report and files"],
  ["method", "Method", "How it comes about, stage by stage"],
];

function FaceSwitch() {
  return (
    <Choice legend="Result or method" choices={FACES} chosen={face.value} choose={showFace} class="faces" />
  );
}

/** The name, the method, the tour, and how the page looks. */

import { METHODS } from "../../shared/stages";
import { METHOD_WORDS } from "../../stages/catalogue";
import { Choice } from "../parts/Choice";
import { LookButtons } from "../parts/LookButtons";
import { setMethod } from "../session/stageRuns";
import { activity } from "../state/activity";
import { method } from "../state/parameters";
import { startTour } from "../tour/steps";
import { showsWorkbench } from "../view/screen/opening";

export function Header() {
  return (
    <header class="header">
      <img src="./icon.svg" alt="" width="22" height="22" />
      <h1>ridgeline</h1>
      <p class="muted">
        <span class="what">Aerial photographs in, textured roof models out. </span>Nothing leaves this
        computer.
      </p>
      {activity.value !== "" && (
        <span class="activity">
          <span class="spinner" aria-hidden="true" />
          {activity}
        </span>
      )}
      {showsWorkbench.value && <MethodChoice />}
      <button type="button" onClick={startTour}>
        Tour
      </button>
      <a class="button" href="./lessons.html">
        Lessons
      </a>
      <LookButtons />
    </header>
  );
}

function MethodChoice() {
  return (
    <Choice
      legend="Method"
      choices={METHODS.map((name) => [name, METHOD_WORDS[name].title, METHOD_WORDS[name].what])}
      chosen={method.value}
      choose={(name) => void setMethod(name)}
      class="methods"
    />
  );
}

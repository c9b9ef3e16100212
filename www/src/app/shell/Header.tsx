/** The name, the method, the tour, and how the page looks. */

import { showsWorkbench } from "../screen/opening";
import { setMethod } from "../session/stageRuns";
import { activity } from "../state/activity";
import type { Method } from "../state/methods";
import { method } from "../state/parameters";
import { biggerText, textScale } from "../state/textScale";
import { theme, toggleTheme } from "../state/theme";
import { startTour } from "../tour/steps";

const METHODS: readonly (readonly [Method, string, string])[] = [
  ["lines", "Lines", "Lines matched over the views, and half-planes at them (Baillard et al. 1999)"],
  [
    "rectangles",
    "Rectangles",
    "Regions, and planes between parallel lines in object space (Wiman, Axelsson 1996)",
  ],
  [
    "combined",
    "Combined",
    "The lines and planes of both compete for one model; regions take most of its time",
  ],
  ["coplanar", "Coplanar", "Sets of coplanar lines and their polygons (Baillard et al. 1999, section 2)"],
  [
    "adjacency",
    "Adjacency",
    "Corners with their edges and regions, matched as wholes (Baillard et al. 1999, section 2)",
  ],
];

export function Header() {
  const other = theme.value === "dark" ? "Light" : "Dark";
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
      <button
        type="button"
        class="quiet"
        aria-label={`Text size: ${Math.round(100 * textScale.value)} %, next`}
        title="Text size"
        onClick={biggerText}
      >
        Aa
      </button>
      <button type="button" class="quiet" onClick={toggleTheme}>
        {other}
      </button>
    </header>
  );
}

function MethodChoice() {
  return (
    <fieldset class="choice methods">
      <legend class="visually-hidden">Method</legend>
      {METHODS.map(([name, title, what]) => (
        <button
          key={name}
          type="button"
          title={what}
          aria-pressed={method.value === name}
          onClick={() => void setMethod(name)}
        >
          {title}
        </button>
      ))}
    </fieldset>
  );
}

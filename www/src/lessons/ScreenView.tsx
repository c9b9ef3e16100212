/** A screen: text and formula on one side, what moves on the other. */

import { PredictionView } from "./PredictionView";
import { Formula, Paragraph, Pieces } from "./parts/Formula";
import { symbolsOfText } from "./parts/formula";
import type { Screen } from "./parts/lesson";
import { guessOf, keyOf } from "./progress";

interface Props {
  lesson: string;
  screen: Screen;
  isOnPaper: boolean;
}

export function ScreenView({ lesson, screen, isOnPaper }: Props) {
  const { id, title, formula, figure: Figure, says, predict, isReal = false } = screen;
  const key = keyOf(lesson, id);
  const isRevealed = predict === undefined || guessOf(key) !== undefined;
  return (
    <article class={`screen ${isReal ? "on-scene" : ""}`} data-screen={id}>
      <div class="tell">
        <h2>{title}</h2>
        <Prose screen={screen} />
        {formula !== undefined && <Written title={title} formula={formula} />}
        {predict !== undefined && <PredictionView name={key} title={title} predict={predict} />}
        <Symbols screen={screen} />
      </div>
      <div class="show">
        {isOnPaper && isReal ? (
          <p class="muted">This figure is drawn from whole photographs, on the page.</p>
        ) : (
          <Figure isRevealed={isRevealed} />
        )}
        {says !== undefined && isRevealed && <Says says={says} />}
      </div>
    </article>
  );
}

function Prose({ screen }: { screen: Screen }) {
  return (
    <>
      {screen.prose().map((text, i) => (
        <Paragraph key={i.toString()} text={text} />
      ))}
    </>
  );
}

function Written({ title, formula }: { title: string; formula: () => string }) {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls is reached by key
    <section class="written" tabIndex={0} aria-label={`Formula: ${title}`}>
      <Formula text={formula()} block />
    </section>
  );
}

function Says({ says }: { says: () => string }) {
  return (
    <p class="says" aria-live="polite">
      <Pieces text={says()} />
    </p>
  );
}

/** What the letters of the screen mean. */
function Symbols({ screen: { prose, formula, predict } }: { screen: Screen }) {
  const asked = predict === undefined ? [] : [predict.question];
  const symbols = symbolsOfText([...prose(), ...asked, ...(formula === undefined ? [] : [`$${formula()}$`])]);
  if (symbols.length === 0) {
    return null;
  }
  return (
    <details class="symbols">
      <summary>Symbols</summary>
      <dl>
        {symbols.map(({ glyph, form, sub, colour, means }) => (
          <div key={`${glyph}${sub ?? ""}${means}`}>
            <dt class={`s${colour} ${form}`}>
              {glyph}
              {sub !== undefined && <sub>{sub}</sub>}
            </dt>
            <dd>{means}</dd>
          </div>
        ))}
      </dl>
    </details>
  );
}

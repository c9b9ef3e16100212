/** What a stage view shows: a paragraph, its equation, and where it stands in the papers. */
import "./figures.css";
import { MathMl } from "../../words/Formula";
import { letterOf, linesOf } from "../../words/formula";
import { spelledOut } from "../../words/papers";
import { Linked } from "../../words/Term";

export interface FigureText {
  title: string;
  /** Paper, section and figures. */
  source: string;
  /** What it shows, with terms of the glossary linked. */
  text: string;
  /** Its equation, a line each, as `words/formula.ts` reads it; the text says what the letters mean. */
  equation: readonly string[];
  /** What to do here. */
  hint: string;
}

export function AboutFigure({ of: { title, source, text, equation, hint } }: { of: FigureText }) {
  return (
    <details class="panel about" open data-testid="about">
      <summary>
        <h2>{title}</h2>
        <span class="muted">{spelledOut(source)}</span>
      </summary>
      <p>
        <Linked text={text} />
      </p>
      <MathMl of={linesOf(equation, letterOf)} block />
      <p class="muted">{hint}</p>
    </details>
  );
}

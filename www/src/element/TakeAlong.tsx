/** What a reader can take along: the figure as a picture, its numbers, its paper, and a link to its state. */
import { useState } from "preact/hooks";
import { FIGURES } from "../app/figures/AboutFigure";
import { saveFile } from "../app/parts/saveFile";
import type { Figure } from "../shared/figure";
import type { FigureState } from "./figureState";
import type { Kind } from "./kinds";
import { citationOf } from "./takeAlong/citation";
import { pngOf, svgOf } from "./takeAlong/pictures";
import { csvOf } from "./takeAlong/tables";

interface Props {
  kind: Kind;
  name: string;
  figure: Figure;
  state: FigureState;
  /** What is drawn. */
  body: () => HTMLElement | null;
  /** The address that opens the figure as it is. */
  link: () => string;
}

/** What is shown below the buttons to be copied. */
type Shown = { label: string; text: string } | null;

export function TakeAlong({ kind, name, figure, state, body, link }: Props) {
  const [shown, show] = useState<Shown>(null);
  const { title } = FIGURES[kind.tab];
  const svg = () => {
    const root = body();
    return root === null ? null : svgOf(root, title);
  };
  const save = (ending: string, type: string, content: string | Blob | null) => {
    if (content !== null) {
      saveFile(`${name}.${ending}`, new Blob([content], { type }));
    }
  };
  const savePng = async () => {
    const drawn = svg();
    if (drawn !== null) {
      save("png", "image/png", await pngOf(drawn));
    }
  };
  const data = () => JSON.stringify({ figure: name, state, rows: kind.rows(figure) }, null, 1);
  return (
    <details class="take">
      <summary>Take along</summary>
      <div class="row">
        <button type="button" onClick={() => save("svg", "image/svg+xml", svg())}>
          SVG
        </button>
        <button type="button" onClick={() => void savePng()}>
          PNG
        </button>
        <button type="button" onClick={() => save("csv", "text/csv", csvOf(kind.rows(figure)))}>
          CSV
        </button>
        <button type="button" onClick={() => save("json", "application/json", data())}>
          JSON
        </button>
        <button type="button" onClick={() => show({ label: "BibTeX", text: citationOf(kind.tab) })}>
          Cite
        </button>
        <button type="button" onClick={() => show({ label: "Link", text: link() })}>
          Link
        </button>
      </div>
      {shown !== null && (
        <textarea
          aria-label={shown.label}
          readOnly
          rows={shown.label === "Link" ? 2 : 9}
          value={shown.text}
          onFocus={(event) => event.currentTarget.select()}
        />
      )}
    </details>
  );
}

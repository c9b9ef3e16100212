/** What a reader can take along: the figure as a picture, its numbers, its paper, and a link to its state. */
import "./takeAlong.css";
import { useState } from "preact/hooks";
import { saveFile } from "../../parts/saveFile";
import type { FigureText } from "../../view/figures/AboutFigure";
import { citationOf } from "./citation";
import { pngOf, svgOf } from "./pictures";
import { csvOf, numbered, type Row } from "./rows";

interface Props {
  of: FigureText;
  /** Of the files. */
  name: string;
  /** The numbers behind it. */
  rows: () => Row[];
  /** What is drawn. */
  body: () => HTMLElement | null;
  /** The address that opens the figure as it is. */
  link: () => string;
}

/** What is shown below the buttons to be copied. */
type Shown = { label: string; text: string } | null;

export function TakeAlong({ of, name, rows, body, link }: Props) {
  const [shown, show] = useState<Shown>(null);
  const svg = () => {
    const root = body();
    return root === null ? null : svgOf(root, of.title);
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
  const data = () => JSON.stringify({ figure: name, link: link(), rows: numbered(rows()) }, null, 1);
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
        <button type="button" onClick={() => save("csv", "text/csv", csvOf(numbered(rows())))}>
          CSV
        </button>
        <button type="button" onClick={() => save("json", "application/json", data())}>
          JSON
        </button>
        <button type="button" onClick={() => show({ label: "BibTeX", text: citationOf(of) })}>
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

/** The picked thing in numbers, with units and the paper's symbols. */

import "./inspector.css";
import { placeAmong, rowsOf, siblingsOf, titleOf } from "../../kinds/kinds";
import type { Bars, Related, Row } from "../../kinds/parts/rows";
import { pageFigure } from "../selection/selectionQueries";
import { face, select, selection, tab } from "../state/viewState";
import { Linked } from "../words/Term";
import type { TermId } from "../words/terms";
import { EvidenceBars } from "./EvidenceBars";

export function Inspector() {
  const picked = selection.value;
  const figure = pageFigure();
  return (
    <section class="panel" data-testid="inspector">
      <div class="row">
        <h2>{face.value === "result" ? "Selected" : "Inspector"}</h2>
        <span class="grow" />
        <Steps />
        {picked !== null && (
          <button
            type="button"
            class="quiet"
            onClick={() => {
              select(null);
            }}
          >
            Clear
          </button>
        )}
      </div>
      {picked === null ? (
        <p class="muted">Click a segment, a line, a half-plane, a facet or a wall to see its numbers.</p>
      ) : (
        <Facts title={titleOf(picked, figure)} rows={rowsOf(picked, figure)} />
      )}
    </section>
  );
}

/** To the previous and the next thing of the kind: what can be picked with a pointer can be reached with keys. */
function Steps() {
  const items = siblingsOf(selection.value, tab.value, pageFigure());
  const at = placeAmong(items, selection.value);
  if (items.length === 0) {
    return null;
  }
  const go = (step: number) => () => {
    const next = at < 0 ? (step > 0 ? 0 : items.length - 1) : (at + step + items.length) % items.length;
    select(items[next] ?? null);
  };
  return (
    <fieldset class="steps-through">
      <legend class="visually-hidden">Go through</legend>
      <button type="button" class="quiet" aria-label="Previous item" title="Previous" onClick={go(-1)}>
        ‹
      </button>
      <span class="muted numbers">
        {at < 0 ? "–" : at + 1} / {items.length}
      </span>
      <button type="button" class="quiet" aria-label="Next item" title="Next" onClick={go(1)}>
        ›
      </button>
    </fieldset>
  );
}

/** Terms in the labels, by their words. */
const TERMS: Record<string, TermId> = { nats: "nat", "Sim(θ)": "similarity", σ: "standard-deviation" };

function Facts({ title, rows }: { title: string; rows: readonly Row[] }) {
  return (
    <>
      <h3 class="picked">{title}</h3>
      <dl class="facts">
        {rows.map(([label, value, note]) => (
          <div key={label} class={isBars(value) ? "broad" : undefined}>
            <dt>
              <Linked text={label.replace(/\bnats\b|Sim\(θ\)|σ/, (word) => `[[${TERMS[word]}|${word}]]`)} />
            </dt>
            <dd class="numbers">
              <Value value={value} />
              {note !== undefined && <span class="muted"> {note}</span>}
            </dd>
          </div>
        ))}
      </dl>
    </>
  );
}

function Value({ value }: { value: Row[1] }) {
  if (typeof value === "string") {
    return <>{value}</>;
  }
  return isBars(value) ? <EvidenceBars bars={value.bars} /> : <Links to={value} />;
}

function isBars(value: Row[1]): value is Bars {
  return typeof value !== "string" && "bars" in value;
}

const MOST_LINKS = 12;

/** Things to go on to. */
export function Links({ to }: { to: readonly Related[] }) {
  if (to.length === 0) {
    return <>–</>;
  }
  return (
    <span class="links">
      {to.slice(0, MOST_LINKS).map(({ name, selection: next }, i) => (
        <button
          key={i}
          type="button"
          class="link"
          onClick={() => {
            select(next);
          }}
        >
          {name}
        </button>
      ))}
      {to.length > MOST_LINKS && <span class="muted">+ {to.length - MOST_LINKS}</span>}
    </span>
  );
}

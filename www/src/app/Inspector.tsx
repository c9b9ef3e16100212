/** The picked thing in numbers, with units and the paper's symbols. */
import { rowsOf, titleOf } from "./inspected";
import type { Related, Row } from "./related";
import { selection } from "./state";

export function Inspector() {
  const picked = selection.value;
  return (
    <section class="panel" data-testid="inspector">
      <div class="row spread">
        <h2>Inspector</h2>
        {picked !== null && (
          <button
            type="button"
            class="quiet"
            onClick={() => {
              selection.value = null;
            }}
          >
            Clear
          </button>
        )}
      </div>
      {picked === null ? (
        <p class="muted">Click a segment, a line, a half-plane, a facet or a wall to see its numbers.</p>
      ) : (
        <Facts title={titleOf(picked)} rows={rowsOf(picked)} />
      )}
    </section>
  );
}

function Facts({ title, rows }: { title: string; rows: readonly Row[] }) {
  return (
    <>
      <h3 class="picked">{title}</h3>
      <dl class="facts">
        {rows.map(([label, value, note]) => (
          <div key={label}>
            <dt>{label}</dt>
            <dd class="numbers">
              {typeof value === "string" ? value : <Links to={value} />}
              {note !== undefined && <span class="muted"> {note}</span>}
            </dd>
          </div>
        ))}
      </dl>
    </>
  );
}

const MOST_LINKS = 12;

function Links({ to }: { to: readonly Related[] }) {
  if (to.length === 0) {
    return <>–</>;
  }
  return (
    <span class="links">
      {to.slice(0, MOST_LINKS).map(({ name, selection: next }) => (
        <button
          key={name}
          type="button"
          class="link"
          onClick={() => {
            selection.value = next;
          }}
        >
          {name}
        </button>
      ))}
      {to.length > MOST_LINKS && <span class="muted">+ {to.length - MOST_LINKS}</span>}
    </span>
  );
}

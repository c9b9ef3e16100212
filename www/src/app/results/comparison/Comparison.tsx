/** Two results: the numbers of the kept one beside the present ones; in space see `keptBeside.ts`. */

import "./comparison.css";
import { keepResult, keptResult } from "../../state/keptResult";
import { results } from "../../state/results";
import { comparedRows, presentResult, presentTitle } from "./comparedResults";

/** Keeps the present model, or lets go of the kept one. */
export function KeepResult() {
  const { facets } = results.value;
  const isKept = keptResult.value !== null;
  if (!isKept && (facets === null || facets.length === 0)) {
    return null;
  }
  return (
    <button
      type="button"
      aria-pressed={isKept}
      title="Keep this result, to compare another method or other parameters with it"
      onClick={() => {
        keepResult(isKept ? null : presentResult());
      }}
    >
      {isKept ? "Discard kept result" : "Compare"}
    </button>
  );
}

/** The table of both. */
export function Comparison() {
  const kept = keptResult.value;
  if (kept === null) {
    return null;
  }
  return (
    <section class="panel" data-testid="comparison">
      <h2>Comparison</h2>
      <table class="comparison">
        <thead>
          <tr>
            <td />
            <th scope="col">
              <span class="swatch merged" aria-hidden="true" /> {kept.title}
              <span class="muted"> (kept)</span>
            </th>
            <th scope="col">{presentTitle}</th>
          </tr>
        </thead>
        <tbody>
          {comparedRows(kept).map(([name, before, now]) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              <td class="numbers">{before}</td>
              <td class="numbers">{now}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <p class="muted">Change the method or parameters, and run: the results stand side by side in space.</p>
    </section>
  );
}

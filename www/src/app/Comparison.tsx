/** Two results side by side: one is kept, its outlines stay in space, and its numbers stand beside the present ones. */
import type { Facet } from "../shared/results";
import { slopedArea } from "./geometry";
import { changedParams } from "./paramForm";
import { defaults, keptResult, method, params, results, stages } from "./state";

/** Keeps the present model, or lets go of the kept one. */
export function KeepResult() {
  const { facets } = results.value;
  const isKept = keptResult.value !== null;
  if (!isKept && (facets === null || facets.length === 0)) {
    return null;
  }
  const toggle = () => {
    keptResult.value = isKept || facets === null ? null : { ...numbers(), facets };
  };
  return (
    <button
      type="button"
      class="quiet"
      aria-pressed={isKept}
      title="Keep this result, to compare another method or other parameters with it"
      onClick={toggle}
    >
      {isKept ? "Drop kept" : "Compare"}
    </button>
  );
}

/** The table of both. */
export function Comparison() {
  const kept = keptResult.value;
  if (kept === null) {
    return null;
  }
  const now = numbers();
  const { facets } = results.value;
  const rows: [string, string, string][] = [
    ["Facets", String(kept.facets.length), facets === null ? "–" : String(facets.length)],
    ["Roof area", areaText(kept.facets), facets === null ? "–" : areaText(facets)],
    ["3D lines", String(kept.lines), String(now.lines)],
    ["Time", `${kept.seconds.toFixed(1)} s`, `${now.seconds.toFixed(1)} s`],
  ];
  return (
    <section class="panel" data-testid="comparison">
      <h2>Comparison</h2>
      <table class="comparison">
        <thead>
          <tr>
            <td />
            <th scope="col">
              <span class="swatch merged" aria-hidden="true" /> {kept.title}
            </th>
            <th scope="col">{now.title}</th>
          </tr>
        </thead>
        <tbody>
          {rows.map(([name, before, after]) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              <td class="numbers">{before}</td>
              <td class="numbers">{after}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

function numbers() {
  const { method: _, ...changed } = changedParams(defaults.value, params.value);
  const count = Object.keys(changed).length;
  const name = method.value === "lines" ? "Lines" : "Rectangles";
  return {
    title: count === 0 ? name : `${name}, ${count} changed`,
    lines: (results.value.lines?.length ?? 0) / 6,
    seconds: stages.value.reduce((sum, { seconds }) => sum + (seconds ?? 0), 0),
  };
}

function areaText(facets: readonly Facet[]): string {
  return `${facets.reduce((sum, facet) => sum + slopedArea(facet), 0).toFixed(0)} m²`;
}

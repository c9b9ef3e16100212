/** How the model looks in the 3D view, and what its colours mean. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { METHOD_COLOURS } from "../../shared/palette";
import { densePlanesOf, type Facet, rectanglesOf } from "../../shared/records";
import type { ModelMode } from "../../viewer/layers/model";
import { counted } from "../parts/counted";
import { keptResult } from "../state/keptResult";
import type { Method } from "../state/methods";
import { method } from "../state/parameters";
import { mainResults } from "../state/results";

const chosen = signal<ModelMode>("textured");
export const modelMode: ReadonlySignal<ModelMode> = chosen;

const MODES: readonly (readonly [ModelMode, string])[] = [
  ["textured", "Textured"],
  ["plain", "Plain"],
  ["wireframe", "Wireframe"],
  ["normals", "Normals"],
  ["method", "By method"],
];

const METHOD_TITLES: Record<Method, string> = {
  lines: "Lines (B99)",
  rectangles: "Rectangles (W96)",
  combined: "Both",
  coplanar: "Coplanar lines (B99 2)",
  adjacency: "Corners (B99 2)",
};

/** The method that proposed a facet's plane; where both ran, both may have. */
export function methodOfFacet(facet: Pick<Facet, "half_planes" | "proposals">, ran: Method): Method {
  if (ran !== "combined" || rectanglesOf(facet).length === 0) {
    return ran === "combined" ? "lines" : ran;
  }
  const byLines = (facet.half_planes ?? []).length > 0 || densePlanesOf(facet).length > 0;
  return byLines ? "combined" : "rectangles";
}

export function facetColours(facets: readonly Facet[] | null, ran: Method): string[] {
  return (facets ?? []).map((facet) => METHOD_COLOURS[methodOfFacet(facet, ran)]);
}

export function ModeSwitches() {
  return (
    <fieldset class="choice">
      <legend class="visually-hidden">Appearance</legend>
      {MODES.map(([name, title]) => (
        <button
          key={name}
          type="button"
          aria-pressed={modelMode.value === name}
          onClick={() => {
            chosen.value = name;
          }}
        >
          {title}
        </button>
      ))}
    </fieldset>
  );
}

/** The numbers of facets that each method made. */
const made = computed(() => {
  const methods = (mainResults.value.facets ?? []).map((facet) => methodOfFacet(facet, method.value));
  const names = (Object.keys(METHOD_TITLES) as Method[]).filter(
    (name) => name === "lines" || name === "rectangles" || method.value === name,
  );
  return names.map((name) => [name, methods.filter((one) => one === name).length] as const);
});

export function ModeLegend() {
  if (modelMode.value === "normals") {
    return (
      <ul class="legend" aria-label="Colours">
        <li>
          <span class="swatch normals" aria-hidden="true" />
          hue: azimuth, saturation: slope
        </li>
      </ul>
    );
  }
  if (modelMode.value !== "method") {
    return null;
  }
  const kept = keptResult.value;
  return (
    <ul class="legend" aria-label="Colours" data-testid="method-legend">
      {made.value.map(([name, count]) => (
        <li key={name}>
          <span class={`swatch by-${name}`} aria-hidden="true" />
          {METHOD_TITLES[name]}: {counted(count, "facets")}
        </li>
      ))}
      {kept !== null && (
        <li>
          <span class="swatch merged" aria-hidden="true" />
          kept: {kept.title}, {counted(kept.facets.length, "facets")}
        </li>
      )}
    </ul>
  );
}

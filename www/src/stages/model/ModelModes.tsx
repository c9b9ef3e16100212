/** How the model looks in the 3D view, and what its colours mean. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { Choice } from "../../app/parts/Choice";
import { counted } from "../../app/parts/counted";
import { Legend } from "../../app/parts/Legend";
import { keptResult } from "../../app/state/keptResult";
import { method } from "../../app/state/parameters";
import { mainResults } from "../../app/state/results";
import { METHOD_COLOURS } from "../../shared/palette";
import { densePlanesOf, type Facet, rectanglesOf } from "../../shared/records";
import { METHODS, type Method } from "../../shared/stages";
import type { ModelMode } from "../../viewer/layers/model";
import { METHOD_WORDS } from "../catalogue";

const chosen = signal<ModelMode>("textured");
export const modelMode: ReadonlySignal<ModelMode> = chosen;

const MODES: readonly (readonly [ModelMode, string])[] = [
  ["textured", "Textured"],
  ["plain", "Plain"],
  ["wireframe", "Wireframe"],
  ["normals", "Normals"],
  ["method", "By method"],
];

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
  return <Choice legend="Appearance" choices={MODES} of={chosen} />;
}

/** The numbers of facets that each method made. */
const made = computed(() => {
  const methods = (mainResults.value.facets ?? []).map((facet) => methodOfFacet(facet, method.value));
  const names = METHODS.filter((name) => name === "lines" || name === "rectangles" || method.value === name);
  return names.map((name) => [name, methods.filter((one) => one === name).length] as const);
});

export function ModeLegend() {
  if (modelMode.value === "normals") {
    return <Legend entries={[["normals", "hue: azimuth, saturation: slope"]]} />;
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
          {METHOD_WORDS[name].legend}: {counted(count, "facets")}
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

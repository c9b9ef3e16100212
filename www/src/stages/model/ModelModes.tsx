/** How the model looks in the 3D view, and what its colours mean. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import { Choice } from "../../app/parts/Choice";
import { counted } from "../../app/parts/counted";
import { Legend } from "../../app/parts/Legend";
import { keptResult } from "../../app/state/keptResult";
import { method } from "../../app/state/parameters";
import { foundSunshine, mainResults } from "../../app/state/results";
import { selection } from "../../app/state/viewState";
import { facetOf } from "../../kinds/kinds";
import { METHOD_COLOURS } from "../../shared/palette";
import { densePlanesOf, type Facet, rectanglesOf } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import { METHODS, type Method } from "../../shared/stages";
import type { ModelMode } from "../../viewer/layers/model";
import { METHOD_WORDS } from "../catalogue";

const chosen = signal<ModelMode>("textured");
export const modelMode: ReadonlySignal<ModelMode> = chosen;

const shown = signal(true);
export const showsObstructions: ReadonlySignal<boolean> = shown;

const MODES: readonly (readonly [ModelMode, string])[] = [
  ["textured", "Textured"],
  ["plain", "Plain"],
  ["wireframe", "Wireframe"],
  ["normals", "Normals"],
  ["method", "By method"],
  ["sun", "Sun"],
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

/** Colours of no sun, and of twelve hours of it a day. */
const SUN_SCALE = [
  [45, 60, 105],
  [255, 214, 64],
] as const;
const MOST_HOURS = 12;

function sunColour(hours: number): string {
  const share = Math.min(1, hours / MOST_HOURS);
  const [none, most] = SUN_SCALE;
  return `rgb(${none.map((from, i) => Math.round(from + share * ((most[i] ?? from) - from))).join()})`;
}

/** What is known of the sun on the present model; null where nothing is. */
const sunshine = computed(() =>
  foundSunshine.value?.of === mainResults.value ? foundSunshine.value.sunshine : null,
);

export const sunColours = computed(() =>
  (sunshine.value ?? []).map(({ hours_a_year: hours }) => sunColour(hours / 365)),
);

export function ModeSwitches() {
  const count = (mainResults.value.facets ?? []).reduce((sum, facet) => sum + facet.obstructions.length, 0);
  return (
    <>
      <Choice legend="Appearance" choices={MODES} of={chosen} />
      {count > 0 && (
        <button
          type="button"
          aria-pressed={shown.value}
          title="What stands on the roofs"
          onClick={() => {
            shown.value = !shown.value;
          }}
        >
          Obstructions ({count})
        </button>
      )}
    </>
  );
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
  if (modelMode.value === "sun") {
    return <SunLegend />;
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

/** Hours of direct sun a day, and those of the selected face by month. */
function SunLegend() {
  const all = sunshine.value;
  if (all === null) {
    const isAsked = foundSunshine.value?.of !== mainResults.value;
    return (
      <p class="legend" role="status" data-testid="sun-legend">
        {isAsked
          ? "The sun is being followed through the year…"
          : "Not known: it needs the place of the model on the Earth. A model of an earlier visit is to be reconstructed again."}
      </p>
    );
  }
  const picked = all[facetOf(selection.value) ?? -1];
  return (
    <div class="legend" data-testid="sun-legend">
      <ul aria-label="Colours">
        {[0, 3, 6, 9, MOST_HOURS].map((hours) => (
          <li key={hours}>
            <span class="swatch" style={{ background: sunColour(hours) }} aria-hidden="true" /> {hours} h
          </li>
        ))}
      </ul>
      <p>
        Direct sun a day, mean of the year: shaded by this model alone, without clouds, trees and hills.
        {picked === undefined
          ? " Select a facet for its months."
          : ` Facet ${numberOf(picked.facet)}: ${(picked.hours_a_year / 365).toFixed(1)} h; January to December ${picked.hours_a_day
              .map((hours) => hours.toFixed(1))
              .join(", ")} h.`}
      </p>
    </div>
  );
}

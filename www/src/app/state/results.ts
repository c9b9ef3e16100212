/** What the stages have found. */
import { computed, type ReadonlySignal, signal } from "@preact/signals";
import type { Facet, Sunshine } from "../../shared/records";
import { REGION_TABS } from "../../stages/catalogue";
import type { Tab } from "../../stages/list";
import { NO_RESULTS, type Results } from "../../stages/list";
import { method } from "./parameters";
import { tab } from "./viewState";

export { NO_RESULTS, type Results };

/** Where a stage's results are kept: in method "combined" both methods have segments, lines and facets of their own. */
type ResultSet = "main" | "regions";
export type ResultSets = Record<ResultSet, Results>;
const found = signal<ResultSets>({ main: NO_RESULTS, regions: NO_RESULTS });

export const allResults: ReadonlySignal<ResultSets> = found;

export function restoreResults(all: ResultSets): void {
  const whole = (results: Results): Results => ({ ...results, tileGlbs: [] });
  found.value = { main: whole(all.main), regions: whole(all.regions) };
}

/** Of which stages the present tab tells. */
export const shownResultSet = computed<ResultSet>(() => resultSetOf(tab.value));
const firstLook = signal<readonly Facet[] | null>(null);
/** The facets of a preliminary model, as long as there are no others: shown in space, and part of no result. */
export const preliminaryFacets = computed(() => (found.value.main.facets === null ? firstLook.value : null));

export function showPreliminary(facets: readonly Facet[] | null): void {
  firstLook.value = facets;
}

/** What the present tab tells of. */
export const results = computed(() => found.value[shownResultSet.value]);
/** What the model is made of. */
export const mainResults = computed(() => found.value.main);

export function setResults(all: Results): void {
  found.value = { main: all, regions: NO_RESULTS };
}

/** Adds what a stage has found that `shownBy` shows. */
export function addResults(shownBy: Tab, some: Partial<Results>): void {
  const set = resultSetOf(shownBy);
  found.value = { ...found.value, [set]: { ...found.value[set], ...some } };
}

/** Adds the model of a tile to those that are shown until all are joined. */
export function addTileModel(glb: Uint8Array<ArrayBuffer>): void {
  const { main } = found.value;
  found.value = { ...found.value, main: { ...main, tileGlbs: [...main.tileGlbs, glb] } };
}

const writtenFiles = signal<string[]>([]);
/** The output files that can be saved. */
export const exportNames: ReadonlySignal<string[]> = writtenFiles;

export function setExportNames(names: string[]): void {
  writtenFiles.value = names;
}

function resultSetOf(name: Tab): ResultSet {
  return method.value === "combined" && REGION_TABS.includes(name) ? "regions" : "main";
}

/** How long the sun shines on each face, once somebody wants to see it. */
interface FoundSunshine {
  /** The results that it belongs to. */
  of: object;
  /** Null where it cannot be known. */
  sunshine: readonly Sunshine[] | null;
}

const sun = signal<FoundSunshine | null>(null);
export const foundSunshine: ReadonlySignal<FoundSunshine | null> = sun;

export function setSunshine(found: FoundSunshine): void {
  sun.value = found;
}

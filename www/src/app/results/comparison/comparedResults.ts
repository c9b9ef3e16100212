/** What is told of a result where two are compared. */
import { computed } from "@preact/signals";
import type { ParamTree } from "../../../shared/paramTree";
import type { Facet } from "../../../shared/records";
import { slopedArea } from "../../../shared/surfaceClass";
import { METHOD_WORDS, methodOf } from "../../../stages/catalogue";
import { fieldText, paramName, paramSections } from "../../settings/parameterForm";
import type { KeptResult } from "../../state/keptResult";
import { defaults, method, params } from "../../state/parameters";
import { mainResults } from "../../state/results";
import { stages } from "../../state/stages";

/** What the present facets were found with, or the next ones will be. */
const presentParams = computed(() => mainResults.value.madeWith ?? params.value);
export const presentTitle = computed(() => titleOf(presentParams.value));

/** The method, and which parameter is not the default; of several, how many. */
function titleOf(values: ParamTree): string {
  const name = METHOD_WORDS[methodOf(values)].title;
  const changed = paramSections(defaults.value, values).flatMap(({ fields }) =>
    fields.filter((field) => field.changed),
  );
  const [only] = changed;
  if (only === undefined) {
    return name;
  }
  const what = `${only.label.toLowerCase()} ${fieldText(only.value)} ${only.unit}`.trimEnd();
  return `${name}, ${changed.length === 1 ? what : `${changed.length} parameters changed`}`;
}

/** The present result, to be kept; null while there are no facets. */
export function presentResult(): KeptResult | null {
  const { facets, glb, lines } = mainResults.value;
  return (
    facets && {
      title: presentTitle.value,
      method: method.value,
      facets,
      glb,
      lines: (lines?.length ?? 0) / 6,
      seconds: secondsOf(),
      params: presentParams.value,
    }
  );
}

type ComparedRow = readonly [name: string, kept: string, now: string];

/** The numbers of two results, and the parameters in which they differ. */
export function comparedRows(kept: KeptResult): ComparedRow[] {
  const { facets, lines } = mainResults.value;
  const either = (text: (found: readonly Facet[]) => string) => (facets === null ? "–" : text(facets));
  return [
    ["Facets", String(kept.facets.length), either(({ length }) => String(length))],
    ["Roof area", areaText(kept.facets), either(areaText)],
    ["3D lines", String(kept.lines), lines === null ? "–" : String(lines.length / 6)],
    ["Time", `${kept.seconds.toFixed(1)} s`, `${secondsOf().toFixed(1)} s`],
    ...parameterRows(kept.params, presentParams.value),
  ];
}

/** The parameters of a method that are not the same; of different methods, the titles say enough. */
function parameterRows(before: ParamTree, after: ParamTree): ComparedRow[] {
  if (methodOf(before) !== methodOf(after)) {
    return [];
  }
  return paramSections(before, after).flatMap(({ path, fields }) =>
    fields
      .filter(({ changed }) => changed)
      .map(
        ({ key, value, fallback }): ComparedRow => [
          paramName(`${path}.${key}`),
          fieldText(fallback),
          fieldText(value),
        ],
      ),
  );
}

function areaText(facets: readonly Facet[]): string {
  return `${facets.reduce((sum, facet) => sum + slopedArea(facet), 0).toFixed(0)} m²`;
}

function secondsOf(): number {
  return stages.value.reduce((sum, { seconds }) => sum + (seconds ?? 0), 0);
}

/** Every kind of things that can be picked, and what is asked of any of them. */
import { formatSelection, type KindName, numberOf, type Selection } from "../shared/selection";
import { type Figure, viewName } from "../stages/figure";
import { type Results, STAGE_FACTS, type Tab } from "../stages/list";
import type { About, Kind, Question } from "./parts/kind";
import { type Mark, shapeMarks, warpedMarks } from "./parts/marks";
import type { Row } from "./parts/rows";
import type { Shape } from "./parts/shapes";

/** By the names of their files. */
export const KINDS = Object.fromEntries(
  Object.entries(
    import.meta.glob<Kind>("./{images,lines,planes,roofs}/*.ts", { eager: true, import: "default" }),
  ).map(([path, kind]) => [path.replace(/.*\/|\.ts$/g, ""), kind]),
) as Readonly<Record<KindName, Kind>>;

export function titleOf(picked: Selection, about: About): string {
  const { title } = KINDS[picked.kind];
  if (typeof title !== "string") {
    return title(picked, about);
  }
  const name = "index" in picked ? `${title} ${numberOf(picked.index)}` : title;
  return "view" in picked ? `${name} of ${viewName(about, picked.view)}` : name;
}

export function rowsOf(picked: Selection, about: About): Row[] {
  return KINDS[picked.kind].rows(picked, about).filter((row): row is Row => Boolean(row));
}

/** The neighbours of the selected thing, or, where nothing is selected, what a tab is about. */
export function siblingsOf(picked: Selection | null, tab: Tab, about: About): readonly Selection[] {
  const kind = picked?.kind ?? STAGE_FACTS[tab].about;
  return kind === undefined ? [] : KINDS[kind].siblings(picked, about);
}

/** Where the selected thing stands among its neighbours; -1 where it does not. */
export function placeAmong(items: readonly Selection[], picked: Selection | null): number {
  const wanted = picked === null ? null : formatSelection(picked);
  return wanted === null ? -1 : items.findIndex((one) => formatSelection(one) === wanted);
}

/** What a selection is in space, local frame; none where it is in an image only. */
export function shapesOf(picked: Selection | null, results: Results): Shape[] {
  return (picked && KINDS[picked.kind].shapes?.(picked, results)) ?? [];
}

/** All that a selection marks in a view. */
export function marksOf(
  picked: Selection | null,
  view: number,
  { scene, results, detail }: Pick<Figure, "scene" | "results" | "detail">,
): Mark[] {
  const info = scene?.views[view];
  if (picked === null || info === undefined) {
    return [];
  }
  const seen = { view, info, results, detail };
  return (
    KINDS[picked.kind].marks?.(picked, seen) ?? [
      ...shapeMarks(shapesOf(picked, results), info),
      ...warpedMarks(seen),
    ]
  );
}

/** The 3D lines that belong to a selection. */
export function linesOf(picked: Selection | null, results: Results): readonly number[] {
  return (picked && KINDS[picked.kind].lines?.(picked, results)) ?? [];
}

/** What the core is asked about a selection, in the results that there are. */
export function questionOf(picked: Selection | null, results: Results): Question | null {
  return (picked && KINDS[picked.kind].question?.(picked, results)) ?? null;
}

/** Is the core asked about things of this kind, once it has run? */
export function asksCore(picked: Selection | null): boolean {
  return picked !== null && KINDS[picked.kind].question !== undefined;
}

/** The facet of the model that a selection is. */
export function facetOf(picked: Selection | null): number | null {
  return (picked && KINDS[picked.kind].facet?.(picked)) ?? null;
}

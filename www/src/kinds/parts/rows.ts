/** The rows of the inspector, and the things that they lead on to. */
import { degreesOf, slopeOf } from "../../app/parts/numberText";
import type { Facet, PlaneGroup, SceneInfo, Vec3 } from "../../shared/records";
import { type IndexedKind, numberOf, type Selection } from "../../shared/selection";
import type { Results } from "../../stages/list";

/** A number of the picked thing, things to go on to (they made it or it made them), or bars. */
export type Row = readonly [label: string, value: string | readonly Related[] | Bars, note?: string];

/** Rows, and in the place of a row what says that there is none. */
export type Rows = readonly (Row | false | null | undefined)[];

export interface Related {
  name: string;
  selection: Selection;
}

/** Amounts for it and against it, positive and negative. */
export interface Bars {
  bars: readonly Bar[];
}

export interface Bar {
  name: string;
  nats: number;
}

/** To the thing of this kind at an index. */
export function linkTo(kind: IndexedKind, index: number): Related {
  return { name: String(numberOf(index)), selection: { kind, index } };
}

/** The number of what has this index, where it is nothing to go on to. */
export const numberRow = (label: string, index: number): Row => [label, String(numberOf(index))];

/** To the things of this kind at these indices. */
export function links(label: string, kind: IndexedKind, indices: readonly number[]): Row {
  return [label, indices.map((index) => linkTo(kind, index))];
}

/** All things of a kind. */
export function numbered(kind: IndexedKind, count: number | undefined): readonly Selection[] {
  return allOf(count, (index) => ({ kind, index }));
}

export function allOf(count: number | undefined, item: (index: number) => Selection): readonly Selection[] {
  return Array.from({ length: count ?? 0 }, (_, index) => item(index));
}

/** The indices of the items that pass. */
export function indicesOf<T>(items: readonly T[] | null | undefined, test: (item: T) => boolean): number[] {
  return (items ?? []).flatMap((item, i) => (test(item) ? [i] : []));
}

/** To the things of this kind that pass; null before their stage has run. */
export function linksWhere<T>(
  label: string,
  kind: IndexedKind,
  items: readonly T[] | null | undefined,
  test: (item: T) => boolean,
): Row | null {
  return items == null ? null : links(label, kind, indicesOf(items, test));
}

/** To the groups and facets that were made from a proposal. */
export function groupsAndFacets(
  { grouping, facets }: Results,
  test: (one: Pick<Facet | PlaneGroup, "proposals">) => boolean,
): Rows {
  return [linksWhere("Groups", "group", grouping?.groups, test), linksWhere("Facets", "facet", facets, test)];
}

export const degreesText = (radians: number) => `${degreesOf(radians).toFixed(1)}°`;

export const slopeText = (normal: Vec3) => degreesText(slopeOf(normal));

/** Clockwise from north. */
export function azimuthText(east: number, north: number): string {
  return `${((degreesOf(Math.atan2(east, north)) + 360) % 360).toFixed(0)}° from north`;
}

/** A point of the local frame in the frame of the input. */
export function worldText(scene: SceneInfo | null, [x, y, z]: Vec3): string {
  const [ox, oy, oz] = scene?.origin ?? [0, 0, 0];
  return `${(x + ox).toFixed(2)}, ${(y + oy).toFixed(2)}, ${(z + oz).toFixed(2)}\u00a0m`;
}

/** The thing that was picked, by its index in the results; anywhere it is picked, it lights up everywhere. */
import type { Side } from "./records";

/** The number by which people know what has this index, in all files too: they count from 1. */
export const numberOf = (index: number): number => index + 1;
export const indexOf = (number: number): number => number - 1;

/**
 * The kinds of things, each with its text in links, "word:field" or "word:field.field". The words are a format and stay; what is
 * known of a kind is in its file in `kinds/`.
 */
const TEXTS = {
  view: "view:index",
  segment: "segment:view.index",
  /** A line of edgels that is no segment. */
  rejectedSegment: "rejected:view.index",
  /** W96: a region of a view. */
  region: "region:view.index",
  line: "line:index",
  /** A side of a 3D line, whether it has a half-plane or not. */
  side: "side:line.side",
  halfplane: "halfplane:index",
  /** W96: a pair of parallel lines. */
  pair: "pair:index",
  /** A rejected cluster of a cluster plane; the selected ones are 3D lines. */
  cluster: "cluster:plane.index",
  /** A plane of dense matching. */
  dense: "dense:index",
  /** A set of coplanar lines. */
  coplanar: "coplanar:index",
  /** A corner in space with its edges and regions. */
  corner: "corner:index",
  group: "group:index",
  facet: "facet:index",
  rejectedFacet: "withdrawn:index",
  /** A place where a roof may be and the model has none. */
  uncoveredRoof: "uncovered:index",
  /** A surface of the model, which is read back as its facet. */
  surface: "facet:facet",
  /** What refinement made of a building. */
  refinement: "refinement:index",
  /** One of the relations tested there. */
  relation: "relation:building.index",
  /** A footprint of the register that is known beforehand. */
  footprint: "footprint:index",
} as const;

type Texts = typeof TEXTS;
export type KindName = keyof Texts;

export const KIND_NAMES = Object.keys(TEXTS) as readonly KindName[];

type FieldsOf<Text> = Text extends `${string}:${infer First}.${infer Second}`
  ? First | Second
  : Text extends `${string}:${infer Only}`
    ? Only
    : never;

interface Surface {
  kind: "surface";
  surface: string;
  building: number | null;
  facet: number | null;
  areaM2: number;
}

/** A selection of one kind. */
export type Picked<K extends KindName> = K extends "surface"
  ? Surface
  : { [N in "kind" | FieldsOf<Texts[K]>]: N extends "kind" ? K : N extends "side" ? Side : number };

export type Selection = { [K in KindName]: Picked<K> }[KindName];

/** The kinds that an index alone tells apart. */
export type IndexedKind = {
  [K in KindName]: FieldsOf<Texts[K]> extends "index" ? K : never;
}[KindName];

/** The index of what is selected, where it is of this kind; -1 where it is not. */
export function pickedIndex(selection: Selection | null, kind: IndexedKind): number {
  return selection?.kind === kind ? (selection as Picked<IndexedKind>).index : -1;
}

/** Where the 3D view's camera stands and what it looks at: x, y, z each, metres, local frame. */
export type Standpoint = readonly [number, number, number, number, number, number];

/** Of each kind the parts of its text. */
const PARTS = Object.fromEntries(
  KIND_NAMES.map((kind) => {
    const [word = "", ...fields] = TEXTS[kind].split(/[:.]/);
    return [kind, { word, fields }];
  }),
) as unknown as Readonly<Record<KindName, { word: string; fields: readonly string[] }>>;

/** "line:12", "segment:0.44", "side:12.left"; null where nothing names it. */
export function formatSelection(picked: Selection): string | null {
  const { word, fields } = PARTS[picked.kind];
  const values = fields.map((name) => (picked as unknown as Record<string, unknown>)[name]);
  return values.includes(null) ? null : `${word}:${values.join(".")}`;
}

/** Null for any other text; where two kinds have the same text, it is the first one. */
export function parseSelection(text: string | null): Selection | null {
  const found = /^([a-z]+):(\d{1,9})(?:\.(\d{1,9}|left|right))?$/.exec(text ?? "") ?? [];
  const [, named, ...values] = found.filter((part) => part !== undefined);
  const isSide = (i: number) => values[i] === "left" || values[i] === "right";
  const kind = KIND_NAMES.find((name) => {
    const { word, fields } = PARTS[name];
    const fits = fields.every((field, i) => (field === "side") === isSide(i));
    return word === named && fields.length === values.length && fits;
  });
  if (kind === undefined) {
    return null;
  }
  const places = PARTS[kind].fields.map((field, i) => [field, isSide(i) ? values[i] : Number(values[i])]);
  return { kind, ...Object.fromEntries(places) } as Selection;
}

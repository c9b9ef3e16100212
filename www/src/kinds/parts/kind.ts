/** What the page knows of a kind of things that can be picked. Each kind is a file; what it leaves out is none. */
import type { Side } from "../../shared/records";
import type { KindName, Picked, Selection } from "../../shared/selection";
import type { Figure } from "../../stages/figure";
import type { Results } from "../../stages/list";
import type { Mark, Seen } from "./marks";
import type { Rows } from "./rows";
import type { Shape } from "./shapes";

/** What is asked for the words and numbers of a thing. */
export type About = Pick<Figure, "scene" | "results" | "params" | "detail" | "view">;

/** What the figures ask the core about a picked thing. */
export type Question =
  | { about: "segment"; view: number; index: number }
  | { about: "side"; line: number; side: Side };

export interface Kind<K extends KindName = KindName> {
  /** What it is over its numbers; a word alone gets its own number, and of things in a view the name of that. */
  title: string | ((picked: Picked<K>, about: About) => string);
  /** Its numbers with units, what made it and what it made. */
  rows(picked: Picked<K>, about: About): Rows;
  /** The things that are gone through from this one, in their order; from none, those of the view that is shown. */
  siblings(picked: Picked<K> | null, about: About): readonly Selection[];
  /** What it is in space, local frame. */
  shapes?(picked: Picked<K>, results: Results): Shape[];
  /** What it looks like in a view, where that is not its shapes seen from there. */
  marks?(picked: Picked<K>, seen: Seen): Mark[];
  /** The 3D lines that belong to it. */
  lines?(picked: Picked<K>, results: Results): readonly number[];
  /** What the core is asked about it; null before the stages have run that answer it. */
  question?(picked: Picked<K>, results: Results): Question | null;
  /** The facet of the model that it is, if any. */
  facet?(picked: Picked<K>): number | null;
}

/**
 * What the page knows of a stage before anything is drawn: `<name>/stage.ts`, gathered in `list.ts`. Names, titles, methods and
 * parameters are the core's own (`shared/stages.ts`).
 */
import type { Args, CallName, Result } from "../shared/calls";
import type { ParamTree } from "../shared/paramTree";
import type { KindName } from "../shared/selection";
import type { StageName } from "../shared/stages";

export interface Stage {
  /** The stage whose tab shows it, where it has none of its own. */
  shownBy?: StageName;
  /** Title of its tab, where the core's own is too long. */
  tabTitle?: string;
  /** The kind of things that are gone through in its tab as long as nothing is picked. */
  about?: KindName;
  /** The slots of the results that are its own, as they are before it has run. */
  nothing?: object;
  /** Asks the core for what it adds to the results, once it has run. */
  fetch?(from: ResultSource): Promise<object>;
  /** Titles of the sections of parameters that are its own, by their paths. */
  sections?: Readonly<Record<string, string>>;
  /** The count that the rail shows; otherwise the first. */
  mainCount?: string;
  /** The things known beforehand of which its tab tells what the images say. */
  known?: readonly ("register" | "terrain" | "cloud")[];
}

/** Who answers, and of what. */
export interface ResultSource {
  call<K extends CallName>(name: K, ...args: Args<K>): Promise<Result<K>>;
  /** How many views the scene has. */
  views: number;
  /** What the stage ran with. */
  params: ParamTree;
}

/** The answers for all views. */
export function perView<K extends "segments" | "matchedSegments" | "rejectedSegments" | "regions">(
  from: ResultSource,
  call: K,
): Promise<Result<K>[]> {
  const views = Array.from({ length: from.views }, (_, view) => view);
  return Promise.all(views.map((view) => from.call(call, ...([view] as Args<K>))));
}

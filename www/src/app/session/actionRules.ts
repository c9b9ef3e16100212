/** What becomes of an action that is started while another is going on: all rules of the page in one table. */
import type { Phase } from "../state/activity";

/** The kinds of actions of the page. */
export type ActionKind =
  /** The core is compiled, or made anew. */
  | "start"
  /** Another project: the demo scene, own files, a new one. */
  | "open"
  /** What a link names, or the project of the last visit: whoever has begun something else wants that. */
  | "restore"
  /** Other files or wishes of the same project, tiles among them. */
  | "change"
  /** Up to a stage, or all. */
  | "run"
  /** A step of the tour: opens and runs what it needs and is not there yet. */
  | "tour"
  | "method"
  /** A file is written, or the project. */
  | "save"
  | "cancel";

/**
 * wait: begins when what is going on has ended.
 * replace: ends what is going on, and all that waits, and takes its place.
 * ignore: nothing happens.
 * beside: done at once; what is going on takes it up.
 */
export type Rule = "wait" | "replace" | "ignore" | "beside";

/** For an action of each kind, by the phase of what is going on. */
export const RULES: Readonly<Record<ActionKind, Readonly<Record<Phase, Rule>>>> = {
  start: { start: "ignore", load: "wait", run: "wait", save: "wait" },
  open: { start: "wait", load: "replace", run: "replace", save: "wait" },
  restore: { start: "wait", load: "ignore", run: "ignore", save: "ignore" },
  change: { start: "wait", load: "replace", run: "replace", save: "wait" },
  run: { start: "wait", load: "wait", run: "ignore", save: "wait" },
  tour: { start: "wait", load: "wait", run: "wait", save: "wait" },
  method: { start: "beside", load: "beside", run: "replace", save: "beside" },
  save: { start: "wait", load: "wait", run: "wait", save: "wait" },
  cancel: { start: "ignore", load: "replace", run: "replace", save: "replace" },
};

/**
 * Actions of the same name, where one is going on: a double click is one click. A step of the tour waits,
 * because it may be another one. Where one is waiting already, both are one by any rule.
 */
export const SAME_AGAIN: Readonly<Record<ActionKind, Rule>> = {
  start: "ignore",
  open: "ignore",
  restore: "ignore",
  change: "replace",
  run: "ignore",
  tour: "wait",
  method: "beside",
  save: "ignore",
  cancel: "ignore",
};

/*
 * Parameters, the number of workers, the kept result and what is looked at are no actions: they change at once. A run
 * that is going on takes changed parameters up: it repeats the stages that read them.
 */

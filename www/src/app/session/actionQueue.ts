/** The queue of the page's actions: one owner of the worker at a time, by the rules of `actionRules.ts`. */
import { batch } from "@preact/signals";
import { type Phase, showActivity, showIdle } from "../state/activity";
import { type ActionKind, RULES, type Rule, SAME_AGAIN } from "./actionRules";

interface Action {
  kind: ActionKind;
  /** Two of one name are the same; without a name an action is like no other. */
  name?: string;
  /** In which phase it begins, and in words what it does besides stages. */
  phase: Phase;
  words?: string;
}

/** What an action knows of its turn. */
export interface Turn {
  /** Aborted when another action takes its place. */
  readonly signal: AbortSignal;
  /** Goes over to another phase. */
  enter(phase: Phase, words?: string): void;
}

type Task = (turn: Turn) => Promise<void> | void;

interface Entry {
  action: Action;
  phase: Phase;
  task: Task;
  end: AbortController;
  done: Promise<void>;
  settle: () => void;
}

interface Hooks {
  /** Stops what is at work in this phase, so that the action that waits for it fails. */
  stop(phase: Phase): void;
  /** Says what failed, and mends it; part of the turn. */
  failed(error: unknown): Promise<void>;
}

export class ActionQueue {
  #present: Entry | null = null;
  #waiting: Entry[] = [];
  readonly #hooks: Hooks;

  constructor(hooks: Hooks) {
    this.#hooks = hooks;
  }

  /** Whether the present action has been replaced and is on its way out. */
  get isEnding(): boolean {
    return this.#present?.end.signal.aborted === true;
  }

  get isIdle(): boolean {
    return this.#present === null;
  }

  /** Does an action by the rules; resolves when it has ended in whatever way. */
  perform(action: Action, task: Task): Promise<void> {
    const same = this.#waiting.find((entry) => isSame(entry.action, action));
    if (same !== undefined) {
      return same.done;
    }
    // What comes last before it: behind an action that is ending, the next one counts.
    const last = this.#waiting.at(-1) ?? (this.isEnding ? null : this.#present);
    switch (last === null ? "wait" : ruleOf(action, last)) {
      case "ignore":
        return last?.done ?? Promise.resolve();
      case "beside":
        return Promise.resolve(task(beside()));
      case "replace":
        this.#endAll();
        return this.#enqueue(action, task);
      case "wait":
        return this.#enqueue(action, task);
    }
  }

  #enqueue(action: Action, task: Task): Promise<void> {
    let settle = () => {};
    const done = new Promise<void>((resolve) => {
      settle = resolve;
    });
    this.#waiting.push({ action, phase: action.phase, task, end: new AbortController(), done, settle });
    if (this.#present === null) {
      this.#next();
    }
    return done;
  }

  #endAll(): void {
    for (const entry of this.#waiting.splice(0)) {
      entry.end.abort();
      entry.settle();
    }
    const present = this.#present;
    if (present !== null && !this.isEnding) {
      present.end.abort();
      this.#hooks.stop(present.phase);
    }
  }

  #next(): void {
    batch(() => {
      this.#present = this.#waiting.shift() ?? null;
      if (this.#present === null) {
        showIdle();
        return;
      }
      void this.#take(this.#present);
    });
  }

  async #take(entry: Entry): Promise<void> {
    const enter = (phase: Phase, words = "") => {
      // A phase that is over does not come back.
      if (!entry.end.signal.aborted) {
        entry.phase = phase;
        showActivity(phase, words);
      }
    };
    enter(entry.action.phase, entry.action.words);
    try {
      await entry.task({ signal: entry.end.signal, enter });
    } catch (error) {
      if (!entry.end.signal.aborted) {
        await this.#hooks.failed(error);
      }
    } finally {
      this.#next();
      entry.settle();
    }
  }
}

function isSame(one: Action, other: Action): boolean {
  return one.name !== undefined && one.kind === other.kind && one.name === other.name;
}

function ruleOf(action: Action, last: Entry): Rule {
  return isSame(action, last.action) ? SAME_AGAIN[action.kind] : RULES[action.kind][last.phase];
}

/** The turn of what is done beside: nothing ends it. */
function beside(): Turn {
  return { signal: new AbortController().signal, enter: () => {} };
}

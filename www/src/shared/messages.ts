/** What page and worker say to each other: one union each way, discriminated by `type`. */
import type { CallName } from "./calls";
import type { AgreementReport } from "./records";

/** Page to worker. */
export type Request =
  | { type: "open"; id: number; wasmUrl: string }
  | { type: "call"; id: number; name: CallName; args: readonly unknown[] };

/**
 * Why a call failed: the input is at fault; the core is, but it still runs; or it stopped for good, of a fault or for want
 * of memory, and the worker must be made anew.
 */
export type FailureKind = "input" | "internal" | "crash" | "memory";

export interface Failure {
  message: string;
  kind: FailureKind;
  /** What the images say, where they speak against the orientation. */
  orientationCheck: AgreementReport | null;
}

/** What a call came to. */
export type Outcome =
  | { type: "done"; id: number; result: unknown }
  | ({ type: "failed"; id: number } & Failure);

/** What the worker tells while it works. */
export interface Told {
  type: "progress";
  stage: string;
  fraction: number;
}

/** Worker to page. */
export type Reply = Outcome | Told;

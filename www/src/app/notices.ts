/** Failures in words. The core's messages end with what to do about them, after a semicolon. */
import type { FailureKind } from "../shared/messages";
import type { Notice } from "./state";

const TITLES: Record<FailureKind, string> = {
  input: "This input cannot be used",
  internal: "Something went wrong",
  crash: "The computation stopped",
};

const ADVICE: Record<Exclude<FailureKind, "input">, string> = {
  internal: "Your files are still here: change the input or the parameters and run again.",
  crash: "It was restarted and your files are still here. Run again with fewer or smaller images.",
};

/** A mistake in the orientation that the core names, and how well the images agree with it and without it. */
export interface Fix {
  before: number;
  after: number;
  words: string;
}

/** What the core says of a mistake that it can undo: an agreement, 0 to 1. */
const CONTRADICTION = /agree to ([\d.]+) as it stands, and to ([\d.]+) if ([^;]+)/;

/** The mistake that a refusal names; null where it names none. */
export function fixOf(message: string): Fix | null {
  const found = CONTRADICTION.exec(message);
  return found === null
    ? null
    : { before: Number(found[1]), after: Number(found[2]), words: (found[3] as string).trim() };
}

/** Does a warning of the core name an offset that it can undo? */
export function isFixable(warning: string): boolean {
  return /are offset against their orientation by [\d.]+ px/.test(warning);
}

/** A failure as a notice: what it is, and what to do. */
export function failureNotice(message: string, kind: FailureKind): Omit<Notice, "id"> {
  const { text, advice } = splitAdvice(message);
  const known = kind === "input" ? advice : (advice ?? ADVICE[kind]);
  const notice = { severity: "error" as const, title: TITLES[kind], text };
  const fix = kind === "input" ? fixOf(message) : null;
  return {
    ...notice,
    // Where the page itself can undo the mistake, that is the advice.
    ...(known !== undefined && fix === null && { advice: known }),
    ...(fix !== null && { fix }),
  };
}

/** Separates what is wrong from what to do, at the last semicolon. */
export function splitAdvice(message: string): { text: string; advice?: string } {
  const at = message.lastIndexOf("; ");
  if (at < 0) {
    return { text: message };
  }
  const advice = message.slice(at + 2);
  return { text: message.slice(0, at), advice: advice.charAt(0).toUpperCase() + advice.slice(1) };
}

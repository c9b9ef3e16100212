/** Failures in words. The core's messages end with what to do about them, after a semicolon. */
import { EngineError } from "../../core/engine";
import type { FailureKind } from "../../shared/messages";
import type { AgreementReport } from "../../shared/records";
import type { Asked, Notice } from "../state/notices";

const TITLES: Record<FailureKind, string> = {
  input: "This input cannot be used",
  internal: "Something went wrong",
  crash: "The computation stopped",
  memory: "There is not enough memory",
};

const ADVICE: Record<Exclude<FailureKind, "input">, string> = {
  internal: "Your files are still here: change the input or the parameters and run again.",
  crash:
    "This is a fault of the program. It was started again with your files, choices and parameters: run again, or save the project and report it.",
  memory:
    "The program was started again with your files. Run with fewer or smaller images, a region of interest, tiles, or fewer workers.",
};

/** What a message of the core asks for. */
export function askedBy(message: string): Asked {
  const { file } = splitFile(message);
  const options = [...message.matchAll(/--([a-z][a-z-]*)/g)].flatMap(([, option]) => option ?? []);
  return { options: [...new Set(options)], files: file === null ? [] : [file] };
}

/** A failure as a notice: what it is, at which stage, what to do, and what the images say of the orientation. */
export function failureNotice(
  message: string,
  kind: FailureKind,
  orientationCheck: AgreementReport | null = null,
  during: string | null = null,
): Omit<Notice, "id"> {
  // Only the core's refusals end with advice; a fault's words are its own.
  const { text, advice } = kind === "input" ? splitAdvice(message) : { text: message };
  const known = kind === "input" ? advice : ADVICE[kind];
  // Where the page itself can undo the mistake, that is the advice.
  const isCurable = orientationCheck !== null && orientationCheck.mistake !== null;
  return {
    severity: "error",
    title: TITLES[kind],
    text: during === null ? text : `${during}: ${text}`,
    ...(known !== undefined && !isCurable && { advice: known }),
    ...(orientationCheck === null ? { asked: askedBy(message) } : { orientationCheck }),
  };
}

/** So many refusals are shown in full: the first ones usually explain the others. */
const MOST_REFUSALS = 4;

/**
 * The core's refusals as notices, one for each cause: files that are refused in the same words share a box that names
 * them all.
 */
export function refusalNotices(problems: readonly string[]): Omit<Notice, "id">[] {
  const causes = new Map<string, string[]>();
  for (const problem of problems) {
    const { file, cause } = splitFile(problem);
    causes.set(cause, [...(causes.get(cause) ?? []), ...(file === null ? [] : [file])]);
  }
  const all = [...causes].map(([cause, named]) => ({
    ...failureNotice(`${listed(named)}${cause}`, "input"),
    asked: { ...askedBy(cause), files: named },
  }));
  const rest = all.length - MOST_REFUSALS;
  const more = {
    severity: "error" as const,
    title: TITLES.input,
    text: rest === 1 ? "There is one more problem." : `There are ${rest} more problems.`,
  };
  return rest > 0 ? [...all.slice(0, MOST_REFUSALS), more] : all;
}

/** "a.pdf: what is wrong" begins with a file; other refusals are about all of them. */
function splitFile(problem: string): { file: string | null; cause: string } {
  const at = problem.indexOf(": ");
  const file = problem.slice(0, Math.max(at, 0));
  return /\.\w{1,9}$/.test(file) ? { file, cause: problem.slice(at + 2) } : { file: null, cause: problem };
}

/** "a.pdf, b.pdf and 3 more: ". */
function listed(names: readonly string[]): string {
  const shown = names.slice(0, MOST_NAMES).join(", ");
  const rest = names.length - MOST_NAMES;
  return names.length === 0 ? "" : `${shown}${rest > 0 ? ` and ${rest} more` : ""}: `;
}

const MOST_NAMES = 3;

/** One of the workers that share a stage stopped: the others are not needed. */
export function workerNotice(failure: Error): Omit<Notice, "id"> {
  const isMemory = failure instanceof EngineError && failure.kind === "memory";
  return {
    severity: "warning",
    title: "A worker stopped",
    text: isMemory
      ? "There was not enough memory for so many workers. The computation goes on with one; the result is the same."
      : `It said: ${failure.message}. The computation goes on with one worker; the result is the same.`,
  };
}

/** The core's words without the options of the command line, for which the page has buttons and fields, and what a decoder says of damage. */
export function onPage(text: string): string {
  return text
    .replaceAll(/\s*\([^()]*--[a-z][^()]*\)/g, "")
    .replace(/: (?:invalid Zip archive|Format error decoding)[^;]*/, ": it is damaged or incomplete");
}

/** Separates what is wrong from what to do, at the last semicolon. */
export function splitAdvice(said: string): { text: string; advice?: string } {
  const message = onPage(said);
  const at = message.lastIndexOf("; ");
  if (at < 0) {
    return { text: message };
  }
  const advice = message.slice(at + 2);
  return { text: message.slice(0, at), advice: advice.charAt(0).toUpperCase() + advice.slice(1) };
}

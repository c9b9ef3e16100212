/** Failures in words. The core's messages end with what to do about them, after a semicolon. */
import type { FailureKind } from "../../shared/messages";
import type { AgreementReport } from "../../shared/records";
import type { Notice } from "../state/notices";

const TITLES: Record<FailureKind, string> = {
  input: "This input cannot be used",
  internal: "Something went wrong",
  crash: "The computation stopped",
};

const ADVICE: Record<Exclude<FailureKind, "input">, string> = {
  internal: "Your files are still here: change the input or the parameters and run again.",
  crash: "It was restarted and your files are still here. Run again with fewer or smaller images.",
};

/** A failure as a notice: what it is, what to do, and what the images say of the orientation. */
export function failureNotice(
  message: string,
  kind: FailureKind,
  orientationCheck: AgreementReport | null = null,
): Omit<Notice, "id"> {
  const { text, advice } = splitAdvice(message);
  const known = kind === "input" ? advice : (advice ?? ADVICE[kind]);
  // Where the page itself can undo the mistake, that is the advice.
  const isCurable = orientationCheck !== null && orientationCheck.mistake !== null;
  return {
    severity: "error",
    title: TITLES[kind],
    text,
    ...(known !== undefined && !isCurable && { advice: known }),
    ...(orientationCheck !== null && { orientationCheck }),
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

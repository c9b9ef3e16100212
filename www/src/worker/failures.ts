/** Why a call failed, from what was thrown and from the core's last words. */
import type { Failure } from "../shared/messages";
import type { AgreementReport } from "../shared/records";

/** `lastWords`: what the core wrote to the console during the call; its panic hook writes the message there. */
export function failureOf(error: unknown, lastWords: string | null): Failure {
  const stop = stopOf(error, lastWords);
  if (stop !== null) {
    return { ...stop, orientationCheck: null };
  }
  if (error instanceof Error) {
    const { agreement: orientationCheck = null } = error as Error & { agreement?: AgreementReport };
    return {
      message: error.message,
      kind: error.name === "InputError" ? "input" : "internal",
      orientationCheck,
    };
  }
  return { message: String(error), kind: "internal", orientationCheck: null };
}

/** Did the core stop for good? Its memory cannot be trusted after that. */
function stopOf(error: unknown, lastWords: string | null): Pick<Failure, "message" | "kind"> | null {
  if (!(error instanceof Error)) {
    return null;
  }
  const panic = panicOf(lastWords);
  if (panic !== null) {
    return { message: panic, kind: "crash" };
  }
  // Running out of memory aborts without a panic: the trap is all that is left of it. The browser's own words differ.
  const isTrap = error instanceof WebAssembly.RuntimeError;
  const saysMemory = /out of memory|memory allocation|allocation failed|memory\.grow|could not allocate/i;
  if ((isTrap && /^unreachable\b/i.test(error.message)) || saysMemory.test(error.message)) {
    return { message: "the images and results need more than the browser gives", kind: "memory" };
  }
  // Too deep a recursion is a RangeError, and leaves the core in the middle of a call.
  const isTooDeep = error instanceof RangeError && /call stack/i.test(error.message);
  return isTrap || isTooDeep ? { message: error.message, kind: "crash" } : null;
}

/** A panic's message and place; null where there was none. */
function panicOf(words: string | null): string | null {
  const found = /panicked at (.+?):(\d+):\d+:\n([\s\S]*)/.exec(words ?? "");
  if (found === null) {
    return null;
  }
  const [, path = "", line = "", message = ""] = found;
  return `${message.trim()} (${path.slice(path.lastIndexOf("src/"))}, line ${line})`;
}

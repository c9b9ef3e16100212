/** What to do about a failure, where its message does not say so itself. */
import type { FailureKind } from "../shared/messages";

/** Cues in the core's messages, most particular first, and the advice that helps then. */
const ADVICE: readonly (readonly [RegExp, string])[] = [
  [/truncat|corrupt|decode|unexpected end|eof/i, "Export the image again, or remove it from the project."],
  [
    /no orientation|without (an )?orientation|not oriented/i,
    "Add the orientation file that names this image, or remove the image. Names are compared without their extension.",
  ],
  [
    /three views|3 views|at least three|fewer than/i,
    "Add oriented photographs that show the same buildings until there are three or more.",
  ],
  [/nan|not finite|finite|singular/i, "Correct this number in the orientation file and add the file again."],
  [/memory|too large/i, "Use fewer or smaller images, or crop them to the buildings of interest."],
];

/** One sentence of advice for a failure. */
export function adviceFor(message: string, kind: FailureKind | "cancelled"): string {
  if (kind === "crash") {
    return "The computation was restarted and your files are still here. Run it again with fewer views, or other parameters.";
  }
  const match = ADVICE.find(([cue]) => cue.test(message));
  return match?.[1] ?? "Your files are still here: change the input or the parameters and run again.";
}

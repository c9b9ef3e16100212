/** What the view of an exercise of any kind is given. */
import type { Verdict } from "../judging/about";

export interface ViewProps<Exercise> {
  exercise: Exercise;
  /** What stands in the editor or the field; null as long as nothing was written. */
  written: string | null;
  onWritten: (written: string) => void;
  /** Draws the values of a number. */
  seed: number;
  onSeed: (seed: number) => void;
  /** Folder of the demo scene, where it is not beside the module. */
  base: string | null;
  theme: string | null;
  /** Makes `<ridgeline-figure>` known. */
  needFigure: () => Promise<unknown>;
  onVerdict: (verdict: Verdict | null) => void;
}

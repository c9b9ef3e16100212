/** `import "ridgeline/exercise"` makes `<ridgeline-exercise>` known. */

export interface Checked {
  /** Of the exercise: "turnToRoof", "heightOfRidge", "triangulate" ... */
  name: string;
  right: boolean;
  /** Which of the usual mistakes the answer makes; null where it makes none that is known. */
  mistake: string | null;
  /** Of the values of a number; null for other exercises. */
  seed: number | null;
}

/** Attributes: name, seed, base, theme. */
export declare class RidgelineExercise extends HTMLElement {
  /** What stands in the editor, JavaScript, or in the field. */
  code: string;
}

declare global {
  interface HTMLElementTagNameMap {
    "ridgeline-exercise": RidgelineExercise;
  }
  interface HTMLElementEventMap {
    "ridgeline-checked": CustomEvent<Checked>;
  }
}

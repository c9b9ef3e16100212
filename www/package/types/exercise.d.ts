/** `import "ridgeline/exercise"` makes `<ridgeline-exercise>` known. */

export interface Checked {
  /** Of the exercise: "fundamentalFromProjections", "triangulate", "ncc", "homographyOfPlane". */
  name: string;
  right: boolean;
  /** Which of the usual mistakes the answer makes; null where it makes none that is known. */
  mistake: string | null;
}

/** Attributes: name, theme. */
export declare class RidgelineExercise extends HTMLElement {
  /** What stands in the editor, JavaScript. */
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

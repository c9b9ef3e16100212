/** What every exercise says of itself, of whichever kind it is. */

/** The lessons that exercises belong to, in their order. */
export const LESSONS = {
  pinhole: "The pinhole camera",
  epipolar: "Epipolar geometry",
  correlation: "Correlation",
  trifocal: "Three views",
  triangulation: "Triangulation and accuracy",
  "lines-in-space": "Lines in space",
  homography: "Homographies of planes",
  roofs: "Roofs from half-planes",
  "object-space": "Search in object space",
  evidence: "Evidence",
} as const;

export type Lesson = keyof typeof LESSONS;

export interface About {
  /** Of the exercise in HTML; of a function, that which is to be written. */
  name: string;
  title: string;
  lesson: Lesson;
  /** Paper and section. */
  source: string;
}

/** A usual mistake. */
export interface NamedMistake {
  name: string;
  /** What was done, and what is to be done instead. */
  says: string;
}

export type Verdict =
  | { kind: "right" }
  | { kind: "form"; says: string }
  | ({ kind: "mistake" } & NamedMistake)
  | { kind: "wrong"; says: string };

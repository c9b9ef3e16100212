/** The exercises, by the names of the functions that are to be written. */
import type { Exercise } from "../judging/judge";
import { fundamentalFromProjections } from "./fundamental";
import { homographyOfPlane } from "./homography";
import { ncc } from "./ncc";
import { triangulate } from "./triangulate";

/** An exercise whose input and answer nobody looks into but itself. */
// biome-ignore lint/suspicious/noExplicitAny: what goes in and comes out differs, and each knows its own
export type AnyExercise = Exercise<any, any>;

export const EXERCISES: readonly AnyExercise[] = [
  fundamentalFromProjections,
  triangulate,
  ncc,
  homographyOfPlane,
];

export function exerciseNamed(name: string | null): AnyExercise | null {
  return EXERCISES.find((one) => one.name === name) ?? null;
}

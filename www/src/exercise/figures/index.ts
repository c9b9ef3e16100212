/** The exercises that are done in a figure, in the order of their lessons. */
import { halfOfPeak, turnToRoof } from "./halfPlanes";
import type { FigureExercise } from "./judgeFigure";
import { hipEnd, ridgeDirection, wholeFace } from "./objectSpace";
import { bestPair } from "./pairs";
import { bestWindows, falseCandidate, pickEave, trueCandidate } from "./segments";

export const FIGURE_EXERCISES: readonly FigureExercise[] = [
  pickEave,
  trueCandidate,
  bestWindows,
  falseCandidate,
  bestPair,
  halfOfPeak,
  turnToRoof,
  hipEnd,
  ridgeDirection,
  wholeFace,
];

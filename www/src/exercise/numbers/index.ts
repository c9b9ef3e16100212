/** The exercises whose answer is a number with its unit, in the order of their lessons. */
import type { NumberExercise } from "../judging/judgeNumber";
import { parallaxOfRidge, sigmaOfHeight, sigmaOfViews } from "./accuracy";
import { groundPixel, imageOfDirection } from "./camera";
import { azimuthOfEave, bitsOfMerging, natsForBelief } from "./information";
import { heightOfRidge, shiftOfWrongPlane, slopeOfHip } from "./planes";

export const NUMBERS: readonly NumberExercise[] = [
  groundPixel,
  imageOfDirection,
  parallaxOfRidge,
  sigmaOfHeight,
  sigmaOfViews,
  slopeOfHip,
  shiftOfWrongPlane,
  heightOfRidge,
  azimuthOfEave,
  bitsOfMerging,
  natsForBelief,
];

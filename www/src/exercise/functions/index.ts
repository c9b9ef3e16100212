/** The functions that are to be written, in the order of their lessons. */
import type { FunctionExercise } from "../judging/judge";
import { angleOfPlane } from "./angle";
import { descriptionLength } from "./codeLength";
import { covarianceOfPoint } from "./covariance";
import { fundamentalFromProjections } from "./fundamental";
import { homographyOfPlane } from "./homography";
import { ncc } from "./ncc";
import { signedOverlap } from "./overlap";
import { lineFromPlanes } from "./planesMeet";
import { posterior } from "./posterior";
import { project } from "./project";
import { transferPoint } from "./transfer";
import { triangulate } from "./triangulate";

/** An exercise whose input and answer nobody looks into but itself. */
// biome-ignore lint/suspicious/noExplicitAny: what goes in and comes out differs, and each knows its own
export type AnyFunction = FunctionExercise<any, any>;

export const FUNCTIONS: readonly AnyFunction[] = [
  project,
  fundamentalFromProjections,
  signedOverlap,
  ncc,
  transferPoint,
  triangulate,
  covarianceOfPoint,
  lineFromPlanes,
  homographyOfPlane,
  angleOfPlane,
  descriptionLength,
  posterior,
];

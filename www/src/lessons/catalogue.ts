/** The ten lessons in their order. */
import { CORRELATION } from "./course/correlation";
import { EPIPOLAR } from "./course/epipolar";
import { LINES_IN_SPACE } from "./course/linesInSpace";
import { PINHOLE } from "./course/pinhole";
import { TRIANGULATION } from "./course/triangulation";
import { TRIFOCAL } from "./course/trifocal";
import type { Lesson } from "./parts/lesson";

export const LESSONS: readonly Lesson[] = [
  PINHOLE,
  EPIPOLAR,
  CORRELATION,
  TRIFOCAL,
  TRIANGULATION,
  LINES_IN_SPACE,
];

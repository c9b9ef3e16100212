/** The ten lessons in their order. */
import { CORRELATION } from "./course/correlation";
import { EPIPOLAR } from "./course/epipolar";
import { EVIDENCE } from "./course/evidence";
import { HOMOGRAPHY } from "./course/homography";
import { LINES_IN_SPACE } from "./course/linesInSpace";
import { OBJECT_SPACE } from "./course/objectSpace";
import { PINHOLE } from "./course/pinhole";
import { ROOFS } from "./course/roofs";
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
  HOMOGRAPHY,
  ROOFS,
  OBJECT_SPACE,
  EVIDENCE,
];

import type { Stage } from "../stage";

/** Where views moved, `followCameras` shows it. */
export const adjustment = {
  shownBy: "matches",
  sections: { adjustment: "Adjustment of the views" },
} satisfies Stage;

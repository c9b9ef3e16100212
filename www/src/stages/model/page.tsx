/** The textured model in space, and the ground around it. */
import { results } from "../../app/state/results";
import type { GroundTexture } from "../../shared/calls";
import type { StagePage } from "../stagePage";
import { buildGround } from "./groundLayer";
import { ModeLegend, ModeSwitches, modelMode } from "./ModelModes";

const GROUND: GroundTexture = {
  about: {
    corners: [
      [0, 1, 0],
      [1, 1, 0],
      [1, 0, 0],
      [0, 0, 0],
    ],
    width: 1,
    height: 1,
  },
  rgba: new Uint8ClampedArray(4),
};

export default {
  layers: {
    model: {
      title: "Model",
      pickOrder: 10,
      isMeasured: true,
      isCut: true,
      Switch: ModeSwitches,
      Legend: ModeLegend,
    },
    ground: {
      title: "Ground",
      plan: () => {
        const { ground } = results.value;
        // Beside a model without photographs on it, it would only distract.
        return modelMode.value === "textured" && ground !== null ? [() => buildGround(ground), ground] : null;
      },
      isMeasured: true,
      isCut: true,
      warm: () => buildGround(GROUND),
    },
  },
  shows: ["model", "ground"],
  isEmpty: ({ glb, tileGlbs }) => glb === null && tileGlbs.length === 0,
} satisfies StagePage;

import { expect, it } from "vitest";
import { planOf, scaleBarM } from "../../../src/app/project/photographs/photographPlan";
import type { PhotoMetadata } from "../../../src/shared/records";

it("lays positions out in metres, in the order of their times", async () => {
  const at = (path: string, position: PhotoMetadata["position"], second: number) => ({
    path,
    stated: {
      camera: "",
      focal_mm: null,
      focal_px: null,
      taken: `2024-01-01 12:00:0${second}`,
      position,
      height_m: null,
      lacks_hemispheres: false,
      yaw_pitch_roll: null,
    },
  });
  const plan = planOf([at("b", [10.001, 60], 2), at("a", [10, 60], 1), at("c", null, 3)]);
  expect(plan.map(({ path }) => path)).toEqual(["a", "b"]);
  // A degree of longitude is half as long at 60 degrees of latitude.
  expect((plan[1]?.east ?? 0) - (plan[0]?.east ?? 0)).toBeCloseTo(55.66, 1);
  expect(scaleBarM(130)).toBe(20);
  expect(scaleBarM(1)).toBeCloseTo(0.2);
});

/** One camera: how large a pixel is on the ground, and where a direction is seen. */
import { DEGREE } from "../../shared/linear";
import { numberExercise } from "../judging/judgeNumber";
import { figures, stepped } from "../judging/values";

export const groundPixel = numberExercise({
  name: "groundPixel",
  title: "A pixel on the ground",
  lesson: "pinhole",
  source: "W96 3.2, B99 2",
  unit: "cm",
  draw: (random) => {
    const principal = stepped(random, 85, 305, 0.05);
    const pixel = stepped(random, 12, 30, 1);
    const terrain = stepped(random, 80, 420, 10);
    const flying = terrain + stepped(random, 600, 1400, 10);
    const size = (height: number) => ((pixel * 1e-6 * height) / (principal * 1e-3)) * 100;
    return {
      text: `A vertical photograph was taken with a [[principal-distance]] of ${principal} mm, from ${flying} m above the sea; the ground lies ${terrain} m above the sea. A pixel of the scanned photograph measures ${pixel} µm. How long is it on the ground?`,
      value: size(flying - terrain),
      solution: `Height above the ground: ${flying} m − ${terrain} m = ${flying - terrain} m. Similar triangles: ${pixel} µm · ${flying - terrain} m / ${principal} mm = ${figures(size(flying - terrain))} cm.`,
      wrong: {
        "terrain forgotten": [size(flying)],
        "terrain added": [size(flying + terrain)],
        "scale inverted": [((pixel * 1e-6 * principal * 1e-3) / (flying - terrain)) * 100],
        "twice the pixel": [2 * size(flying - terrain), size(flying - terrain) / 2],
      },
    };
  },
  mistakes: {
    "terrain forgotten":
      "The height above the sea stands where the height above the ground should: subtract that of the terrain.",
    "terrain added":
      "The height of the terrain is added. The camera is as far above the ground as both heights differ.",
    "scale inverted":
      "The scale is upside down: an image is smaller than the ground, by principal distance over height above ground.",
    "twice the pixel": "This is off by a factor of two: the length of a whole pixel is asked for.",
  },
});

export const imageOfDirection = numberExercise({
  name: "imageOfDirection",
  title: "Where a direction is seen",
  lesson: "pinhole",
  source: "B99 3.1",
  unit: "px",
  tolerance: 0.0002,
  draw: (random) => {
    const focal = stepped(random, 1400, 3200, 50);
    const centre = stepped(random, 380, 440, 0.25);
    const angle = stepped(random, 4, 11, 0.5);
    const at = centre + focal * Math.tan(angle * DEGREE);
    return {
      text: `A camera has a focal length of ${focal} px and its [[principal-point]] at u₀ = ${centre} px; the centre of the first pixel is at 0.5. A point is seen ${angle}° to the right of the optical axis, in the row of the principal point. At which u is its image?`,
      value: at,
      solution: `u = u₀ + f tan α = ${centre} px + ${focal} px · tan ${angle}° = ${figures(at, 6)} px. The principal point is in the coordinates of the image already: nothing else is to be added.`,
      wrong: {
        "half a pixel": [at + 0.5, at - 0.5],
        "principal point forgotten": [at - centre],
        "angle for tangent": [centre + focal * angle * DEGREE],
        "radians for degrees": [centre + focal * Math.tan(angle)],
        "sine for tangent": [centre + focal * Math.sin(angle * DEGREE)],
        "wrong side": [centre - focal * Math.tan(angle * DEGREE)],
      },
    };
  },
  mistakes: {
    "half a pixel":
      "Half a pixel is added or subtracted. The principal point is in the coordinates of the image already, whatever these are.",
    "principal point forgotten":
      "The result counts from the principal point: add u₀, which says where that is in the image.",
    "angle for tangent":
      "The angle itself stands where its tangent should: an image plane is flat, so that directions further out lie further apart.",
    "radians for degrees":
      "The tangent is that of as many radians as there are degrees. Multiply by π / 180 first.",
    "sine for tangent":
      "The sine stands where the tangent should: the focal length is measured along the axis, not along the ray.",
    "wrong side": "The point is to the right of the axis, and u grows to the right: add.",
  },
});

/** Planes and roofs: angles, heights, and what a wrong plane does to an image. */
import { DEGREE } from "../../shared/linear";
import { numberExercise } from "../judging/judgeNumber";
import { figures, SAID, stepped } from "../judging/values";

export const slopeOfHip = numberExercise({
  name: "slopeOfHip",
  title: "How steep a hip is",
  lesson: "lines-in-space",
  source: "B99 4.2, figure 19",
  unit: "deg",
  draw: (random) => {
    const slope = stepped(random, 24, 50, 0.2);
    const rise = Math.tan(slope * DEGREE);
    const right = Math.atan(rise / Math.SQRT2) / DEGREE;
    return {
      text: `Two roof planes, both with a slope of ${slope}°, meet in a [[hip]]; their eaves are at right angles, so that in plan the hip runs at 45° to both. What is the slope of the hip?`,
      value: right,
      solution: `Where a plane has risen by tan ${slope}° per metre away from its eave, the hip has gone √2 m in plan: tan of its slope is tan ${slope}° / √2, and the slope ${figures(right)}°.`,
      wrong: {
        "slope of the planes": [slope],
        "angle divided": [slope / Math.SQRT2],
        "√2 upside down": [Math.atan(rise * Math.SQRT2) / DEGREE],
        "half the rise": [Math.atan(rise / 2) / DEGREE],
        "radians for degrees": [right * DEGREE],
        "sine for tangent": [Math.asin(Math.sin(slope * DEGREE) / Math.SQRT2) / DEGREE],
        "from the vertical": [90 - right],
      },
    };
  },
  mistakes: {
    "slope of the planes": "This is the slope of the planes. The hip runs obliquely in them, and is flatter.",
    "angle divided":
      "The angle itself is divided by √2. It is the rise, its tangent, that is spread over a longer way.",
    "√2 upside down":
      "The hip would be steeper than the planes in which it lies. Its way in plan is longer, by √2: divide.",
    "half the rise": "The way in plan is √2 as long, not twice: it is the diagonal of a square.",
    "radians for degrees": SAID.resultInRadians,
    "sine for tangent":
      "The sine stands where the tangent should: rise over the way in plan, not over the way in the plane.",
    "from the vertical": "This is the angle from the vertical. A slope is measured from the horizontal.",
  },
});

export const shiftOfWrongPlane = numberExercise({
  name: "shiftOfWrongPlane",
  title: "What a wrong angle does to the images",
  lesson: "homography",
  source: "B99 4.1",
  unit: "px",
  draw: (random) => {
    const focal = stepped(random, 8000, 16000, 500);
    const depth = stepped(random, 900, 1400, 50);
    const base = stepped(random, 200, 400, 20);
    const away = stepped(random, 2, 5, 0.5);
    const tried = stepped(random, 10, 20, 1);
    const truth = tried + stepped(random, 14, 25, 1);
    const shift = (dz: number, b = base, z = depth ** 2) => (focal * b * dz) / z;
    const dz = away * (Math.tan(truth * DEGREE) - Math.tan(tried * DEGREE));
    return {
      text: `A [[half-plane]] is tried at θ = ${tried}° about a level eave; the roof rises at ${truth}°. Two vertical photographs with a focal length of ${focal} px were taken ${base} m apart, and the eave is ${depth} m below them. By how many pixels do the two images of a roof point, ${away} m away from the eave in plan, miss each other under the [[homography]] H(θ)? (The height error is small against the depth: Δp ≈ f B ΔZ / Z².)`,
      value: shift(dz),
      solution: `The tried plane is too low there, by ΔZ = ${away} m · (tan ${truth}° − tan ${tried}°) = ${figures(dz, 3)} m. Δp = ${focal} px · ${base} m · ΔZ / (${depth} m)² = ${figures(shift(dz))} px.`,
      wrong: {
        "tangent of the difference": [shift(away * Math.tan((truth - tried) * DEGREE))],
        "angle for tangent": [shift(away * (truth - tried) * DEGREE)],
        "height for height error": [
          shift(away * Math.tan(truth * DEGREE)),
          shift(away * Math.tan(tried * DEGREE)),
        ],
        "radians for degrees": [shift(away * (Math.tan(truth) - Math.tan(tried)))],
        "depth not squared": [shift(dz, base, depth)],
        "baseline forgotten": [shift(dz, 1), (focal * dz) / depth],
        "baseline doubled": [shift(dz, 2 * base)],
      },
    };
  },
  mistakes: {
    "tangent of the difference":
      "The tangent of the difference of the angles is not the difference of their tangents.",
    "angle for tangent": "The difference of the angles stands where that of their tangents should.",
    "height for height error":
      "This is the height of one plane above the eave. What counts is how far the two are apart.",
    "radians for degrees": SAID.tangentsOfDegrees,
    "depth not squared": "The depth counts squared: the parallax is f B / Z, and its derivative f B / Z².",
    "baseline forgotten":
      "The distance between the photographs is missing: from one place, a wrong plane cannot be seen.",
    "baseline doubled": SAID.baselineDoubled,
  },
});

export const heightOfRidge = numberExercise({
  name: "heightOfRidge",
  title: "From half-planes to a ridge",
  lesson: "roofs",
  source: "B99 4.1, 4.2",
  unit: "m",
  draw: (random) => {
    const width = stepped(random, 7, 13, 0.2);
    const low = stepped(random, 22, 33, 1);
    const high = low + stepped(random, 7, 16, 1);
    const [a, b] = [Math.tan(low * DEGREE), Math.tan(high * DEGREE)];
    const right = (width * a * b) / (a + b);
    return {
      text: `Two eaves at the same height run parallel, ${width} m apart. Their [[half-plane|half-planes]] rise towards each other at ${low}° and ${high}°. How high above the eaves is the [[ridge]] where they meet?`,
      value: right,
      solution: `At a distance x from the first eave: x tan ${low}° = (${width} m − x) tan ${high}°. The height is w · tan α tan β / (tan α + tan β) = ${figures(right)} m.`,
      wrong: {
        "ridge in the middle": [(width / 2) * a, (width / 2) * b, (width / 4) * (a + b)],
        "whole width": [width * a, width * b],
        "radians for degrees": [(width * Math.tan(low) * Math.tan(high)) / (Math.tan(low) + Math.tan(high))],
        "sine for tangent": [
          (width * Math.sin(low * DEGREE) * Math.sin(high * DEGREE)) /
            (Math.sin(low * DEGREE) + Math.sin(high * DEGREE)),
        ],
        "rises added": [width * (a + b)],
        "place for height": [(width * b) / (a + b), (width * a) / (a + b)],
      },
    };
  },
  mistakes: {
    "ridge in the middle":
      "The ridge is taken to be in the middle. Planes of different slope meet nearer to the steeper eave.",
    "whole width": "A plane rises as far as the ridge only, not over the whole width.",
    "radians for degrees": SAID.tangentsOfDegrees,
    "sine for tangent":
      "The sine stands where the tangent should: distances between eaves are measured in plan.",
    "rises added":
      "The two rises are added. The same height is reached from both sides: their ways add up to the width.",
    "place for height": "This is how far the ridge is from an eave, in plan. Its height is asked for.",
  },
});

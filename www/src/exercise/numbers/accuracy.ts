/** Two views and more: parallax, and how well a height is known. */
import { counted } from "../../app/parts/counted";
import { numberExercise } from "../judging/judgeNumber";
import { figures, SAID, stepped } from "../judging/values";

export const parallaxOfRidge = numberExercise({
  name: "parallaxOfRidge",
  title: "The parallax of a ridge",
  lesson: "epipolar",
  source: "B99 2, 3.1",
  unit: "px",
  draw: (random) => {
    const focal = stepped(random, 8000, 16000, 500);
    const height = stepped(random, 900, 1400, 50);
    const base = stepped(random, 200, 400, 10);
    const ridge = stepped(random, 6, 14, 0.5);
    const parallax = (f: number, b: number) => f * b * (1 / (height - ridge) - 1 / height);
    return {
      text: `Two vertical photographs were taken ${height} m above level ground, ${base} m apart, with a focal length of ${focal} px. A [[ridge]] is ${ridge} m above the ground. By how many pixels does its image move more than that of the ground below it, from one photograph to the other ([[parallax]])?`,
      value: parallax(focal, base),
      solution: `A point at depth Z moves by f B / Z. Ridge: ${focal} px · ${base} m / ${height - ridge} m; ground: ${focal} px · ${base} m / ${height} m. Difference: ${figures(parallax(focal, base))} px.`,
      wrong: {
        "whole parallax": [(focal * base) / (height - ridge), (focal * base) / height],
        "baseline doubled": [parallax(focal, 2 * base)],
        "half the baseline": [parallax(focal, base / 2)],
        "baseline forgotten": [parallax(focal, 1), (focal * ridge) / height],
        "height for depth": [(focal * base) / ridge],
      },
    };
  },
  mistakes: {
    "whole parallax":
      "This is how far one of the points moves. The ground moves as well; the height is in the difference of both.",
    "baseline doubled": SAID.baselineDoubled,
    "half the baseline":
      "Half the baseline: each camera is half of it away from the middle, and the images move in both.",
    "baseline forgotten":
      "The distance between the photographs is missing: without it, this is the length of the height itself in one image.",
    "height for depth":
      "The height of the ridge stands where the depth should: how far a point is from the camera decides how far its image moves.",
  },
});

export const sigmaOfHeight = numberExercise({
  name: "sigmaOfHeight",
  title: "The standard deviation of a height",
  lesson: "triangulation",
  source: "B99 3.4, figure 9",
  unit: "cm",
  draw: (random) => {
    const focal = stepped(random, 8000, 16000, 500);
    const depth = stepped(random, 800, 1400, 50);
    const base = stepped(random, 180, 420, 20);
    const sigma = stepped(random, 0.2, 0.45, 0.05);
    const of = (b: number, s: number, z = depth ** 2) => (z / (b * focal)) * s * 100;
    const right = of(base, sigma * Math.SQRT2);
    return {
      text: `Two vertical photographs with a focal length of ${focal} px were taken ${base} m apart; a roof is ${depth} m below them. In each of them the place of a point along the baseline is measured with a [[standard-deviation]] of ${sigma} px, independently. What is the standard deviation of its height?`,
      value: right,
      solution: `Z = f B / p, so σ_Z = Z² / (f B) · σ_p. The parallax p is a difference of two measurements: σ_p = √2 · ${sigma} px = ${figures(sigma * Math.SQRT2, 3)} px. σ_Z = ${depth}² m² / (${focal} px · ${base} m) · σ_p = ${figures(right)} cm.`,
      wrong: {
        "one measurement": [of(base, sigma)],
        "deviations added": [of(base, 2 * sigma)],
        "variance for standard deviation": [
          of(base, 2 * sigma ** 2),
          ((depth ** 2 / (base * focal)) * sigma) ** 2 * 2 * 100,
        ],
        "depth not squared": [of(base, sigma * Math.SQRT2, depth)],
        "baseline doubled": [of(2 * base, sigma * Math.SQRT2)],
        "baseline forgotten": [(depth / focal) * sigma * Math.SQRT2 * 100],
      },
    };
  },
  mistakes: {
    "one measurement": "√2 is missing: a parallax is a difference of two measurements, whose variances add.",
    "deviations added": "The standard deviations are added. It is variances that add: √2, not 2.",
    "variance for standard deviation":
      "This is made of variances, whose unit is squared. The standard deviation is the square root.",
    "depth not squared":
      "The depth counts squared: once because the image gets smaller, and once because the rays get more parallel.",
    "baseline doubled": SAID.baselineDoubled,
    "baseline forgotten":
      "This is the standard deviation in the plane, Z / f · σ. Across it, the depth is as much worse as the baseline is smaller than the depth.",
  },
});

export const sigmaOfViews = numberExercise({
  name: "sigmaOfViews",
  title: "Accuracy against the number of views",
  lesson: "triangulation",
  source: "B99 3.4, figure 9",
  unit: "cm",
  draw: (random) => {
    const before = stepped(random, 2, 4, 1);
    const after = before + stepped(random, 2, 4, 1);
    const sigma = stepped(random, 6, 18, 0.5);
    const right = sigma * Math.sqrt(before / after);
    return {
      text: `A line is seen by ${counted(before, "views")} and known with a [[standard-deviation]] of ${sigma} cm. With what standard deviation is it known when it is seen by ${after}, each of which says as much as each of these, with errors that are independent?`,
      value: right,
      solution: `Information adds: from ${before} to ${after} it grows by ${after}/${before}, and the variance is ${before}/${after} of what it was. σ = ${sigma} cm · √(${before}/${after}) = ${figures(right)} cm.`,
      wrong: {
        "variance for standard deviation": [(sigma * before) / after],
        "more views, worse": [sigma * Math.sqrt(after / before), (sigma * after) / before],
        "only the new views": [sigma * Math.sqrt(before / (after - before))],
        "as if from one view": [sigma / Math.sqrt(after)],
        "no difference": [sigma],
      },
    };
  },
  mistakes: {
    "variance for standard deviation":
      "It is the variance that goes with the number of views. The standard deviation goes with its square root.",
    "more views, worse": "The quotient is upside down: more views make a line better known.",
    "only the new views": "The first views count as well: their information adds to that of the new ones.",
    "as if from one view":
      "The standard deviation that is given is that of several views already, not of one.",
    "no difference": "Independent views average their errors: more of them do help.",
  },
});

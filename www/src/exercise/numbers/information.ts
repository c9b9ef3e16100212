/** Object space and evidence: azimuths, bits and nats. */
import { DEGREE } from "../../shared/linear";
import { numberExercise } from "../judging/judgeNumber";
import { figures, SAID, stepped } from "../judging/values";

export const azimuthOfEave = numberExercise({
  name: "azimuthOfEave",
  title: "The azimuth of a line",
  lesson: "object-space",
  source: "W96 3.4, figures 4 and 5",
  unit: "deg",
  draw: (random) => {
    const start = [stepped(random, 10, 30, 0.5), stepped(random, 10, 30, 0.5)] as const;
    const direction = stepped(random, 108, 158, 0.5);
    const length = stepped(random, 8, 14, 0.5);
    const step = [length * Math.cos(direction * DEGREE), length * Math.sin(direction * DEGREE)] as const;
    const end = [Number((start[0] + step[0]).toFixed(2)), Number((start[1] + step[1]).toFixed(2))] as const;
    const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
    const right = Math.atan2(dy, dx) / DEGREE;
    return {
      text: `An image line, cut with a horizontal plane, runs from X = ${start[0]} m, Y = ${start[1]} m to X = ${end[0]} m, Y = ${end[1]} m. At which azimuth does it count in the histogram of [[main-direction|main directions]]: from X towards Y, between 0° and 180°?`,
      value: right,
      solution: `ΔX = ${figures(dx)} m, ΔY = ${figures(dy)} m. atan2(ΔY, ΔX) = ${figures(right)}°; a line has no direction, so that 180° may be added or subtracted, which is not needed here.`,
      wrong: {
        "from north": [90 - right, 450 - right, 270 - right],
        "quadrant lost": [Math.atan(dy / dx) / DEGREE, Math.abs(Math.atan(dy / dx) / DEGREE)],
        "radians for degrees": [right * DEGREE],
        "the perpendicular direction": [right - 90, right + 90],
        "of the points": [Math.atan2(start[1], start[0]) / DEGREE, Math.atan2(end[1], end[0]) / DEGREE],
      },
    };
  },
  mistakes: {
    "from north":
      "This counts from north, clockwise, as a compass does, or ΔX and ΔY have changed places. Here azimuths count from X towards Y.",
    "quadrant lost":
      "The arc tangent of a quotient does not know which of both is negative: take atan2(ΔY, ΔX), or add 180°.",
    "radians for degrees": SAID.resultInRadians,
    "the perpendicular direction":
      "This is the perpendicular direction: the other main direction of the building, not that of this line.",
    "of the points": "This is the azimuth of one end as seen from the origin. Subtract the ends first.",
  },
});

export const bitsOfMerging = numberExercise({
  name: "bitsOfMerging",
  title: "What merging two regions saves",
  lesson: "object-space",
  source: "W96 3.3",
  unit: "bits",
  draw: (random) => {
    const count = stepped(random, 60, 160, 10);
    const vectors = stepped(random, 2, 5, 1);
    const cost = stepped(random, 11, 16, 1);
    const apart = stepped(random, 3, 6, 0.5);
    const together = Number((apart * stepped(random, 1.02, 1.1, 0.01)).toFixed(2));
    const values = 2 * count * Math.log2(together / apart);
    // Two regions cost twice log2 n, their union once log2 2n.
    const parameters = 2 * Math.log2(count) - Math.log2(2 * count);
    const boundary = vectors * cost;
    const right = boundary + parameters - values;
    return {
      text: `Two [[region|regions]] have n = ${count} independent grey values each, with a standard deviation of ${apart}; of both together it is ${together}. Between them are ${vectors} vectors, which cost ${cost} bits each. A region costs n log₂ s for its values and log₂ n for its two parameters. By how much does the [[description-length]] get shorter when they are merged?`,
      value: right,
      solution: `Saved: ${vectors} · ${cost} = ${boundary} bits of boundary, and 2 log₂ ${count} − log₂ ${2 * count} = ${figures(parameters, 3)} bits of parameters. Lost: ${2 * count} · log₂ (${together} / ${apart}) = ${figures(values, 3)} bits of values. In all ${figures(right)} bits.`,
      wrong: {
        "wrong sign": [-right],
        "values forgotten": [boundary + parameters],
        "parameters forgotten": [boundary - values],
        "boundary forgotten": [parameters - values, values - parameters],
        "variance for standard deviation": [boundary + parameters - 2 * values],
        "values of one region": [boundary + parameters - values / 2],
        "nats for bits": [boundary + (parameters - values) * Math.LN2],
        "log10 for log2": [boundary + (parameters - values) * Math.log10(2)],
        "costs added": [boundary + parameters + values],
      },
    };
  },
  mistakes: {
    "wrong sign": "The sign is wrong: what gets shorter is before less after.",
    "values forgotten": "The grey values cost more after merging, since one mean fits both parts less well.",
    "parameters forgotten":
      "The parameters are missing: one region has one mean and one variance to tell, not two.",
    "boundary forgotten": "The boundary is missing: when regions are merged, the vectors between them go.",
    "variance for standard deviation": "n log₂ s is n/2 log₂ s²: the logarithm of the variance counts half.",
    "values of one region": "The merged region has twice as many values.",
    "nats for bits": "The logarithms are natural. Bits take the logarithm to the base 2.",
    "log10 for log2": "The logarithms are those to the base 10. Bits take the logarithm to the base 2.",
    "costs added": "What the values cost more is to be subtracted from what is saved.",
  },
});

export const natsForBelief = numberExercise({
  name: "natsForBelief",
  title: "How much evidence it takes",
  lesson: "evidence",
  source: "B99 5",
  unit: "nats",
  draw: (random) => {
    const before = stepped(random, 0.04, 0.24, 0.02);
    const after = stepped(random, 0.72, 0.96, 0.02);
    const logOdds = (p: number) => Math.log(p / (1 - p));
    const right = logOdds(after) - logOdds(before);
    return {
      text: `One candidate in ${figures(1 / before, 3)} is true: before anything is measured, a line is true with the probability ${before} ([[prior]]). How much [[evidence]] does it take until it is true with the probability ${after}?`,
      value: right,
      solution: `Logarithms of odds add: ln (${after} / ${figures(1 - after, 2)}) − ln (${before} / ${figures(1 - before, 2)}) = ${figures(logOdds(after), 3)} + ${figures(-logOdds(before), 3)} = ${figures(right)} nats.`,
      wrong: {
        "log10 for ln": [right * Math.LOG10E],
        "bits for nats": [right * Math.LOG2E],
        "probability for odds": [Math.log(after / before)],
        "prior forgotten": [logOdds(after)],
        "wrong sign": [-right, logOdds(after) + logOdds(before)],
        "difference of probabilities": [after - before],
      },
    };
  },
  mistakes: {
    "log10 for ln": "The logarithm is that to the base 10. Nats are natural logarithms.",
    "bits for nats": "The number is that of bits. One nat is 1.44 bits.",
    "probability for odds":
      "This is the logarithm of the quotient of the probabilities. Evidence multiplies odds, p / (1 − p).",
    "prior forgotten":
      "This begins with even odds. The prior has odds of its own, which are to be made up for first.",
    "wrong sign":
      "A sign is wrong: the prior speaks against the candidate, so that it takes more evidence, not less.",
    "difference of probabilities": "Probabilities are subtracted. What adds are logarithms of odds.",
  },
});

/** The answers of the numbers, found another way from the words of the task alone: by projecting points, cutting planes, adding up codes. */
import { describe, expect, it } from "vitest";
import { plain } from "../../../src/app/words/linkedText";
import { drawOf } from "../../../src/exercise/judging/judgeNumber";
import { NUMBERS } from "../../../src/exercise/numbers";

const DEGREE = Math.PI / 180;
const SEEDS = Array.from({ length: 20 }, (_, i) => 104_729 * i + 11);

/** Where a camera above a place sees a point beside it, pixels. */
const image = (f: number, camera: number, x: number, depth: number) => (f * (x - camera)) / depth;

/** What makes a function zero, by halving. */
function root(f: (x: number) => number, low: number, high: number): number {
  let [a, b] = [low, high];
  for (let i = 0; i < 80; i += 1) {
    const middle = (a + b) / 2;
    [a, b] = Math.sign(f(middle)) === Math.sign(f(a)) ? [middle, b] : [a, middle];
  }
  return (a + b) / 2;
}

/** By the numbers of the text, in their order. */
const ANOTHER_WAY: Readonly<Record<string, (...of: number[]) => number>> = {
  groundPixel: (mm = 0, flying = 0, terrain = 0, micrometres = 0) =>
    root((length) => image(mm * 1e-3, 0, length / 100, flying - terrain) - micrometres * 1e-6, 0, 1000),
  imageOfDirection: (f = 0, u0 = 0, _first = 0, angle = 0) =>
    u0 + image(f, 0, Math.sin(angle * DEGREE), Math.cos(angle * DEGREE)),
  parallaxOfRidge: (height = 0, base = 0, f = 0, ridge = 0) => {
    const moves = (depth: number) => image(f, 0, 40, depth) - image(f, base, 40, depth);
    return moves(height - ridge) - moves(height);
  },
  sigmaOfHeight: (f = 0, base = 0, depth = 0, sigma = 0) => {
    const [u, v] = [image(f, 0, 30, depth), image(f, base, 30, depth)];
    const found = (a: number, b: number) => (f * base) / (a - b);
    const step = 1e-4;
    const slopes = [found(u + step, v) - depth, found(u, v + step) - depth].map((one) => one / step);
    return 100 * Math.hypot(...slopes.map((slope) => slope * sigma));
  },
  sigmaOfViews: (before = 0, sigma = 0, after = 0) => {
    const each = 1 / sigma ** 2 / before;
    return Math.sqrt(1 / Array.from({ length: after }, () => each).reduce((all, one) => all + one, 0));
  },
  slopeOfHip: (slope = 0) => {
    const rise = Math.tan(slope * DEGREE);
    // z = rise · x and z = rise · y: normals (−rise, 0, 1) and (0, −rise, 1).
    const [x, y, z] = [-rise, -rise, -rise * rise];
    return Math.atan(Math.abs(z) / Math.hypot(x, y)) / DEGREE;
  },
  shiftOfWrongPlane: (tried = 0, rises = 0, f = 0, base = 0, depth = 0, away = 0) => {
    const heights = [tried, rises].map((angle) => away * Math.tan(angle * DEGREE));
    const moves = (z: number) => image(f, 0, 20, depth - z) - image(f, base, 20, depth - z);
    return moves(heights[1] ?? 0) - moves(heights[0] ?? 0);
  },
  heightOfRidge: (width = 0, low = 0, high = 0) => {
    const first = (x: number) => x * Math.tan(low * DEGREE);
    const second = (x: number) => (width - x) * Math.tan(high * DEGREE);
    return first(root((x) => first(x) - second(x), 0, width));
  },
  azimuthOfEave: (x0 = 0, y0 = 0, x1 = 0, y1 = 0) => {
    const across = (angle: number) =>
      (x1 - x0) * Math.sin(angle * DEGREE) - (y1 - y0) * Math.cos(angle * DEGREE);
    return root(across, 90, 180);
  },
  bitsOfMerging: (n = 0, apart = 0, together = 0, vectors = 0, bits = 0) => {
    const region = (count: number, sigma: number) => count * Math.log2(sigma) + Math.log2(count);
    return region(n, apart) + region(n, apart) + vectors * bits - region(2 * n, together);
  },
  natsForBelief: (_count = 0, before = 0, after = 0) => {
    const belief = (nats: number) => {
      const [yes, no] = [before * Math.exp(nats), 1 - before];
      return yes / (yes + no);
    };
    return root((nats) => belief(nats) - after, 0, 20);
  },
};

describe.each(NUMBERS.map((exercise) => [exercise.name, exercise] as const))("%s", (name, exercise) => {
  it("is what another way comes to", () => {
    for (const seed of SEEDS) {
      const { text, value } = drawOf(exercise, seed);
      const given = [
        ...plain(text)
          .replaceAll("u₀", "")
          .matchAll(/\d+(?:\.\d+)?/g),
      ].map(([one]) => Number(one));
      const found = ANOTHER_WAY[name]?.(...given) ?? Number.NaN;
      const share = name === "shiftOfWrongPlane" ? 0.01 : 0.002;
      expect(Math.abs(found - value), `seed ${seed}: ${found} beside ${value} of ${given}`).toBeLessThan(
        share * Math.abs(value),
      );
    }
  });
});

/** The mathematics of the drawn figures: planted and recovered. */
import { describe, expect, it } from "vitest";
import {
  atDepth,
  atHeight,
  centreOf,
  depthOf,
  fundamental,
  imageOf,
  mapped,
  planeHomography,
  planeOfLine,
  pointAtHeight,
  projected,
  projection,
} from "../../../src/lessons/toy/camera";
import {
  ACROSS,
  aerial,
  CORNERS,
  EDGES,
  photograph,
  SLOPE,
  surfaceAt,
  VIEWS,
} from "../../../src/lessons/toy/house";
import {
  type Ends2,
  lineError,
  lineOfTwo,
  nearestOnRays,
  partBetween,
  predicted,
  transferredLine,
  trifocal,
} from "../../../src/lessons/toy/lines";
import {
  covarianceOf,
  jacobian,
  reprojectionError,
  triangulated,
} from "../../../src/lessons/toy/triangulation";
import {
  meanSquare,
  ncc,
  peakOf,
  planeAt,
  relit,
  similarity,
  warpedWindow,
  windowAt,
} from "../../../src/lessons/toy/windows";
import {
  apply3,
  clipLine,
  cross,
  determinant,
  distance2,
  dot,
  homogeneous,
  lineDistance,
  lineThrough,
  mix3,
  norm,
  point2,
  sub,
  transpose,
} from "../../../src/shared/linear";
import type { Vec2, Vec3 } from "../../../src/shared/records";

const [FIRST, SECOND] = VIEWS;
const POINTS: readonly Vec3[] = [...Object.values(CORNERS), [3, -7, 0], [-6, 2, 11]];

describe("a camera", () => {
  it("looks at what it looks at, with x to the right and y down", () => {
    const camera = aerial([0, 0, 40], [0, 0, 0]);
    expect(imageOf(camera, [0, 0, 0])).toEqual([160, 120]);
    expect(imageOf(camera, [4, 0, 0])[0]).toBeCloseTo(160 + (450 * 4) / 40, 9);
    expect(imageOf(camera, [0, 4, 0])[1]).toBeCloseTo(120 - (450 * 4) / 40, 9);
    expect(determinant(camera.R)).toBeCloseTo(1, 12);
  });

  it("has the depth as the third number of P X, and its centre in the kernel of P", () => {
    for (const X of POINTS) {
      expect(projected(projection(FIRST), X)[2]).toBeCloseTo(depthOf(FIRST, X), 9);
    }
    expect(norm(projected(projection(FIRST), FIRST.C))).toBeLessThan(1e-9);
    expect(norm(sub(centreOf(projection(FIRST)), FIRST.C))).toBeLessThan(1e-9);
  });

  it("sees a point at every depth of its ray in one place", () => {
    const x: Vec2 = [77, 201];
    for (const depth of [5, 20, 60]) {
      expect(distance2(imageOf(FIRST, atDepth(FIRST, x, depth)), x)).toBeLessThan(1e-9);
    }
    expect(atHeight(FIRST, x, 3)[2]).toBeCloseTo(3, 12);
    expect(norm(sub(pointAtHeight(projection(FIRST), x, 3), atHeight(FIRST, x, 3)))).toBeLessThan(1e-9);
  });

  it("photographs the house where it projects it", () => {
    const inside = imageOf(FIRST, [0, -2, 6.5]);
    expect(surfaceAt(FIRST, inside).name).toBe("south roof");
    expect(surfaceAt(FIRST, imageOf(FIRST, [8, 8, 0])).name).toBe("ground");
    const { grey, width } = photograph(FIRST);
    const at = ([x, y]: Vec2) => grey[Math.floor(y) * width + Math.floor(x)] as number;
    // Sun on the south, shade on the north.
    const mean = (y: number, z: number) =>
      [-4, -2, 0, 2, 4].reduce((sum, x) => sum + at(imageOf(FIRST, [x, y, z])), 0) / 5;
    expect(mean(-2, 6.5)).toBeGreaterThan(mean(2, 6.5) + 10);
  });
});

describe("two views", () => {
  const F = fundamental(projection(FIRST), projection(SECOND));

  it("have x'T F x = 0 for every point, rank 2, and the epipoles as kernels", () => {
    for (const X of POINTS) {
      const line = apply3(F, homogeneous(imageOf(FIRST, X)));
      expect(lineDistance(line, imageOf(SECOND, X))).toBeLessThan(1e-8);
      expect(lineDistance(line, [10, 10])).toBeGreaterThan(1);
    }
    expect(Math.abs(determinant(F))).toBeLessThan(1e-12);
    const e = homogeneous(point2(projected(projection(FIRST), SECOND.C)));
    const e2 = homogeneous(point2(projected(projection(SECOND), FIRST.C)));
    expect(norm(apply3(F, e)) / norm(e)).toBeLessThan(1e-10);
    expect(norm(apply3(transpose(F), e2)) / norm(e2)).toBeLessThan(1e-10);
  });

  it("have x' = l' x (F x) for the points of a line across the baseline", () => {
    const [p, q] = [CORNERS.southEaveWest, CORNERS.ridgeWest];
    const line = lineThrough(imageOf(SECOND, p), imageOf(SECOND, q));
    for (const t of [0, 0.3, 0.8]) {
      const X = mix3(p, q, t);
      const x2 = point2(cross(line, apply3(F, homogeneous(imageOf(FIRST, X)))));
      expect(distance2(x2, imageOf(SECOND, X))).toBeLessThan(1e-7);
    }
  });

  it("meet in the line that they see, if it does not run along the baseline", () => {
    const [one, other] = ACROSS;
    for (const [p, q] of EDGES.slice(0, 3)) {
      const seen = [one, other].map((camera): Ends2 => [imageOf(camera, p), imageOf(camera, q)]);
      const [a, b] = partBetween(lineOfTwo([one, other], seen as [Ends2, Ends2]), 0, p[0], q[0]);
      expect(norm(sub(a, p))).toBeLessThan(1e-6);
      expect(norm(sub(b, q))).toBeLessThan(1e-6);
    }
    const [p, q] = EDGES[0] as readonly [Vec3, Vec3];
    const sineOf = (cameras: typeof VIEWS) => {
      const [c, d] = cameras;
      return lineOfTwo(
        [c, d],
        [
          [imageOf(c, p), imageOf(c, q)],
          [imageOf(d, p), imageOf(d, q)],
        ],
      ).sine;
    };
    expect(sineOf(VIEWS)).toBeLessThan(1e-3);
    expect(sineOf(ACROSS)).toBeGreaterThan(0.2);
  });

  it("have the plane of a line through the centre and the line", () => {
    const [p, q] = [CORNERS.ridgeWest, CORNERS.ridgeEast];
    const { n, d } = planeOfLine(projection(FIRST), lineThrough(imageOf(FIRST, p), imageOf(FIRST, q)));
    for (const X of [p, q, FIRST.C]) {
      expect(Math.abs(dot(n, X) + d)).toBeLessThan(1e-9);
    }
  });

  it("know a homography of each plane, and of no other", () => {
    const { n, d } = planeAt([CORNERS.southEaveWest, CORNERS.southEaveEast], SLOPE);
    const H = planeHomography(FIRST, SECOND, n, d);
    for (const X of [CORNERS.ridgeEast, CORNERS.southEaveWest, [2, -1.6, 6.8] as const]) {
      expect(Math.abs(dot(n, X) + d)).toBeLessThan(1e-9);
      expect(distance2(mapped(H, imageOf(FIRST, X)), imageOf(SECOND, X))).toBeLessThan(1e-8);
    }
    expect(distance2(mapped(H, imageOf(FIRST, [3, -9, 0])), imageOf(SECOND, [3, -9, 0]))).toBeGreaterThan(5);
  });
});

describe("a third view", () => {
  const [one, other, third] = ACROSS;
  const WIRE = [
    [-9, 5, 11],
    [9, -3, 7],
  ] as const;
  const inView = (camera: (typeof ACROSS)[number]): Ends2 => [
    imageOf(camera, WIRE[0]),
    imageOf(camera, WIRE[1]),
  ];

  it("shows a line where planes and tensor predict it", () => {
    const line = predicted([one, other], [inView(one), inView(other)], third);
    const T = trifocal(projection(third), projection(one), projection(other));
    const same = transferredLine(T, lineThrough(...inView(one)), lineThrough(...inView(other)));
    for (const X of WIRE) {
      expect(lineDistance(line, imageOf(third, X))).toBeLessThan(1e-6);
      expect(lineDistance(same, imageOf(third, X))).toBeLessThan(1e-6);
    }
  });

  it("leaves no error for a line that is right, and some for one that is not", () => {
    const measured = ACROSS.map(inView);
    expect(lineError(ACROSS, measured, WIRE)).toBeLessThan(1e-9);
    expect(lineError(ACROSS, measured, [WIRE[0], [9, -3, 8]])).toBeGreaterThan(1);
  });
});

describe("triangulation", () => {
  const matrices = VIEWS.map(projection);
  const X: Vec3 = [1.5, -2.2, 6.1];

  it("finds a planted point from afar", () => {
    const found = triangulated(
      matrices,
      VIEWS.map((camera) => imageOf(camera, X)),
      [4, 4, 0],
    );
    expect(norm(sub(found, X))).toBeLessThan(1e-7);
  });

  it("takes the point of least reprojection error", () => {
    const seen = VIEWS.map((camera, i): Vec2 => {
      const [x, y] = imageOf(camera, X);
      return [x + 2 * i, y - 3 * i];
    });
    const found = triangulated(matrices, seen, X);
    const least = reprojectionError(matrices, seen, found);
    for (const by of [
      [0.02, 0, 0],
      [0, 0.02, 0],
      [0, 0, 0.02],
      [0, 0, -0.02],
    ] as const) {
      const near: Vec3 = [found[0] + by[0], found[1] + by[1], found[2] + by[2]];
      expect(reprojectionError(matrices, seen, near)).toBeGreaterThan(least);
    }
  });

  it("has the covariance of the rule of thumb for parallel cameras", () => {
    const pair = [-4, 4].map((x) => ({ ...aerial([x, 0, 40], [x, 0, 0]) }));
    const covariance = covarianceOf(pair.map(projection), [0, 0, 0], 0.5);
    const rule = ((40 ** 2 * Math.SQRT2) / (450 * 8)) * 0.5;
    expect(Math.sqrt(covariance[2]?.[2] ?? 0) / rule).toBeCloseTo(1, 1);
  });

  it("has a covariance that noise confirms", () => {
    let seed = 1;
    const random = () => {
      seed = (seed * 16807) % 2147483647;
      return seed / 2147483647;
    };
    const gauss = () => Math.sqrt(-2 * Math.log(random())) * Math.cos(2 * Math.PI * random());
    const zs = Array.from({ length: 400 }, () => {
      const seen = VIEWS.map((camera): Vec2 => {
        const [x, y] = imageOf(camera, X);
        return [x + 0.5 * gauss(), y + 0.5 * gauss()];
      });
      return triangulated(matrices, seen, X)[2] - X[2];
    });
    const sigma = Math.sqrt(zs.reduce((sum, z) => sum + z * z, 0) / zs.length);
    expect(sigma / Math.sqrt(covarianceOf(matrices, X, 0.5)[2]?.[2] ?? 0)).toBeCloseTo(1, 0.5);
    expect(jacobian(matrices[0] as (typeof matrices)[number], X)).toHaveLength(2);
  });

  it("finds the nearest points of two rays", () => {
    const [p, q] = nearestOnRays(
      [
        [0, 0, 0],
        [1, 0, 0],
      ],
      [
        [5, -3, 2],
        [5, 3, 2],
      ],
    );
    expect(norm(sub(p, [5, 0, 0]))).toBeLessThan(1e-12);
    expect(norm(sub(q, [5, 0, 2]))).toBeLessThan(1e-12);
  });
});

describe("windows", () => {
  const pictures = VIEWS.map((camera) => ({ camera, picture: photograph(camera) }));
  const [first, second] = pictures as [(typeof pictures)[number], (typeof pictures)[number]];
  const EAVE = [CORNERS.southEaveWest, CORNERS.southEaveEast] as const;

  it("correlate whatever their brightness and contrast, and not if one is constant", () => {
    const a = windowAt(first.picture, [160, 140], 15);
    expect(ncc(a, relit(a, 0.4, 30))).toBeCloseTo(1, 12);
    expect(ncc(a, relit(a, -1, 200))).toBeCloseTo(-1, 12);
    expect(meanSquare(a, relit(a, 1, 30))).toBeCloseTo(900, 9);
    expect(
      ncc(
        a,
        a.map(() => 7),
      ),
    ).toBe(0);
  });

  it("are alike through the homography of their plane, and no other", () => {
    const x = imageOf(FIRST, [0, -2, 6.5]);
    const own = windowAt(first.picture, x, 21);
    const by = (theta: number) => {
      const { n, d } = planeAt(EAVE, theta);
      return ncc(own, warpedWindow(second.picture, planeHomography(FIRST, SECOND, n, d), x, 21));
    };
    expect(by(SLOPE)).toBeGreaterThan(0.85);
    expect(by(SLOPE - 0.3)).toBeLessThan(by(SLOPE) - 0.3);
  });

  it("find the slope of the roof as the peak of Sim(theta)", () => {
    const angles = Array.from({ length: 31 }, (_, i) => ((-75 + 5 * i) * Math.PI) / 180);
    const points = [0.8, 1.6, 2.4].flatMap((away) =>
      [-3, -1, 1, 3].map((along) => ({
        x: imageOf(FIRST, [along, -4 + away, 5 + away * Math.tan(SLOPE)]),
        distance: away,
      })),
    );
    const { theta, height, amplitude } = peakOf(
      angles,
      angles.map((angle) => similarity(first, second, EAVE, angle, points)),
    );
    expect(Math.abs(theta - SLOPE)).toBeLessThan((4 * Math.PI) / 180);
    expect(height).toBeGreaterThan(0.4);
    expect(amplitude).toBeGreaterThan(0.2);
  });
});

describe("lines of an image", () => {
  it("are cut to the image", () => {
    const line = lineThrough([-50, 100], [500, 150]);
    const part = clipLine(line, 320, 240);
    expect(part?.every(([x, y]) => x >= -1e-9 && x <= 320.001 && y >= 0 && y <= 240)).toBe(true);
    expect(part?.every((x) => lineDistance(line, x) < 1e-9)).toBe(true);
    expect(clipLine(lineThrough([-10, 500], [400, 600]), 320, 240)).toBeNull();
  });
});

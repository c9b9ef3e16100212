/** A point from several views: the one of least reprojection error, and its covariance. */
import { add, apply3, inverse, type Mat, point2 } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { projected } from "./camera";

const STEP_M = 1e-4;
const ROUNDS = 12;

/** How an image point moves with the point in space: 2 x 3, pixels a metre. */
export function jacobian(P: Mat, X: Vec3): Mat {
  const columns = [0, 1, 2].map((i) => {
    const by = [0, 0, 0] as [number, number, number];
    by[i] = STEP_M;
    const back = by.map((one) => -one) as unknown as Vec3;
    const [x0, y0] = point2(projected(P, add(X, back)));
    const [x1, y1] = point2(projected(P, add(X, by)));
    return [(x1 - x0) / (2 * STEP_M), (y1 - y0) / (2 * STEP_M)] as const;
  });
  return [columns.map(([dx]) => dx), columns.map(([, dy]) => dy)];
}

/** JᵀJ over all views, each a projection matrix. */
function normalMatrix(views: readonly Mat[], X: Vec3): Mat {
  const N = [0, 1, 2].map(() => [0, 0, 0]);
  for (const P of views) {
    for (const row of jacobian(P, X)) {
      N.forEach((out, i) => {
        out.forEach((_, j) => {
          out[j] = (out[j] as number) + (row[i] as number) * (row[j] as number);
        });
      });
    }
  }
  return N;
}

/** Covariance of the point, square metres, where image points have a standard deviation of `sigma` pixels. */
export function covarianceOf(views: readonly Mat[], X: Vec3, sigma: number): Mat {
  return inverse(normalMatrix(views, X)).map((row) => row.map((one) => one * sigma ** 2));
}

/** The point whose images lie nearest to the measured ones (Gauss-Newton). */
export function triangulated(views: readonly Mat[], seen: readonly Vec2[], start: Vec3): Vec3 {
  let X = start;
  for (let round = 0; round < ROUNDS; round += 1) {
    const g = [0, 0, 0] as [number, number, number];
    views.forEach((P, k) => {
      const [x, y] = point2(projected(P, X));
      const residual = [(seen[k] as Vec2)[0] - x, (seen[k] as Vec2)[1] - y];
      jacobian(P, X).forEach((row, r) => {
        for (const i of [0, 1, 2] as const) {
          g[i] += (row[i] as number) * (residual[r] as number);
        }
      });
    });
    X = add(X, apply3(inverse(normalMatrix(views, X)), g));
  }
  return X;
}

/** Root of the mean squared distance, pixels, between the measured points and the images of X. */
export function reprojectionError(views: readonly Mat[], seen: readonly Vec2[], X: Vec3): number {
  const sum = views.reduce((all, P, k) => {
    const [x, y] = point2(projected(P, X));
    const [u, v] = seen[k] as Vec2;
    return all + (u - x) ** 2 + (v - y) ** 2;
  }, 0);
  return Math.sqrt(sum / views.length);
}

/** A point from several views: the one of least reprojection error, and its covariance. */
import {
  add,
  apply,
  apply3,
  distance2,
  inverse,
  type Mat,
  norm,
  point2,
  sub,
  times,
  transpose,
} from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { projected } from "./camera";

const STEP_M = 1e-4;
const ROUNDS = 12;

/** How an image point moves with the point in space: 2 x 3, pixels a metre. */
export function jacobian(P: Mat, X: Vec3): Mat {
  const columns = [0, 1, 2].map((i) => {
    const at = (step: number) => point2(projected(P, X.with(i, (X[i] as number) + step) as unknown as Vec3));
    const [[x0, y0], [x1, y1]] = [at(-STEP_M), at(STEP_M)];
    return [(x1 - x0) / (2 * STEP_M), (y1 - y0) / (2 * STEP_M)] as const;
  });
  return [columns.map(([dx]) => dx), columns.map(([, dy]) => dy)];
}

/** JᵀJ over all views, each a projection matrix. */
function normalMatrix(views: readonly Mat[], X: Vec3): Mat {
  const J = views.flatMap((P) => jacobian(P, X));
  return times(transpose(J), J);
}

/** Covariance of the point, square metres, where image points have a standard deviation of `sigma` pixels. */
export function covarianceOf(views: readonly Mat[], X: Vec3, sigma: number): Mat {
  return inverse(normalMatrix(views, X)).map((row) => row.map((one) => one * sigma ** 2));
}

/** The point whose images lie nearest to the measured ones (Gauss-Newton). */
export function triangulated(views: readonly Mat[], seen: readonly Vec2[], start: Vec3): Vec3 {
  let X = start;
  for (let round = 0; round < ROUNDS; round += 1) {
    const J = views.flatMap((P) => jacobian(P, X));
    const residuals = views.flatMap((P, k) => sub(seen[k] as Vec2, point2(projected(P, X))));
    X = add(X, apply3(inverse(normalMatrix(views, X)), apply(transpose(J), residuals)));
  }
  return X;
}

/** Root of the mean squared distance, pixels, between the measured points and the images of X. */
export function reprojectionError(views: readonly Mat[], seen: readonly Vec2[], X: Vec3): number {
  const off = views.map((P, k) => distance2(seen[k] as Vec2, point2(projected(P, X))));
  return norm(off) / Math.sqrt(views.length);
}

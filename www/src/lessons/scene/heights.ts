/** Between which heights a scene may lie, from its cameras alone. */
import {
  add,
  apply3,
  distance2,
  dot,
  homogeneous,
  inverse,
  type Mat,
  norm,
  outer,
  point2,
  scaled,
  sub,
  sum,
  unit,
} from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { centreOf, partsOf, pointAtHeight, projected } from "../toy/camera";

interface Seeing {
  width: number;
  height: number;
  P: Mat;
}

/** Heights more than this above or below the middle are not offered, metres. */
const MOST_M = 60;

/**
 * The height at which the middles of all photographs come together, and how far to look above and below. Photographs of one place
 * have their middles near each other on it; where the rays are parallel, an overlap of three quarters is taken.
 */
export function heightsOf(views: readonly Seeing[]): { middle: number; reach: number } {
  const rays = views.map(({ P, width, height }) => ({
    centre: centreOf(P),
    ray: unit(downwards(apply3(inverse(partsOf(P).A), homogeneous([width / 2, height / 2])))),
  }));
  const meet = meetOf(rays);
  const above = Math.max(...rays.map(({ centre }) => centre[2]));
  const distance = meet === null ? parallelDistance(views) : above - meet;
  return { middle: above - distance, reach: Math.min(MOST_M, 0.3 * distance) };
}

const IDENTITY = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

const downwards = (ray: Vec3): Vec3 => (ray[2] < 0 ? ray : scaled(ray, -1));

/** The height of the point nearest to all rays; null where they are too parallel to say. */
function meetOf(rays: readonly { centre: Vec3; ray: Vec3 }[]): number | null {
  // Across each ray: I - r rᵀ.
  const across = rays.map(({ ray }) => sum(IDENTITY, outer(ray, ray), -1));
  const right = rays.map(({ centre }, i) => apply3(across[i] as Mat, centre)).reduce((a, b) => add(a, b));
  const spread = Math.min(...rays.map(({ ray }) => dot(ray, (rays[0] as { ray: Vec3 }).ray)));
  if (spread > Math.cos(0.06)) {
    return null;
  }
  const z = apply3(inverse(across.reduce((a, b) => sum(a, b))), right)[2];
  return rays.every(({ centre }) => z < centre[2]) ? z : null;
}

function parallelDistance(views: readonly Seeing[]): number {
  const centres = views.map(({ P }) => centreOf(P));
  const nearest = centres.map((one, i) =>
    Math.min(...centres.filter((_, j) => j !== i).map((other) => norm(sub(one, other)))),
  );
  const baseline = [...nearest].sort((a, b) => a - b)[Math.floor(nearest.length / 2)] as number;
  const { P, width } = views[0] as Seeing;
  // Pixels by which a metre at a distance of one metre moves the image.
  const step = distance2(
    point2(projected(P, add(centreOf(P), [0, 0, -1]))),
    point2(projected(P, add(centreOf(P), [1, 0, -1]))),
  );
  return (4 * baseline * step) / width;
}

/** Where a point of one view is seen in another, if it lies at a height. */
export function transferred(from: Mat, to: Mat, x: Vec2, height: number): Vec2 {
  return point2(projected(to, pointAtHeight(from, x, height)));
}

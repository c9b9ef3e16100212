/** The drawn house and its photographs: a gable, ridge from west to east, on level ground; metres, Z up. */
import { add, apply3, cross, dot, inverse, sub, transpose, unit } from "../../shared/linear";
import type { Vec2, Vec3 } from "../../shared/records";
import { type Camera, calibration, depthOf, imageOf, lookingAt, rayOf } from "./camera";

/** Half of its length and width, heights of eaves and ridge. */
export const HOUSE = { length: 5, width: 4, eave: 5, ridge: 8 } as const;
/** Slope of its roof, radians: 36.9 degrees. */
export const SLOPE = Math.atan2(HOUSE.ridge - HOUSE.eave, HOUSE.width);

const { length: a, width: b, eave, ridge } = HOUSE;

export type FaceName = "south roof" | "north roof" | "east" | "west" | "south" | "north";

export interface Face {
  name: FaceName;
  corners: readonly Vec3[];
  normal: Vec3;
}

const FACES: readonly Face[] = [
  face("south roof", [-a, -b, eave], [a, -b, eave], [a, 0, ridge], [-a, 0, ridge]),
  face("north roof", [a, b, eave], [-a, b, eave], [-a, 0, ridge], [a, 0, ridge]),
  face("east", [a, -b, 0], [a, b, 0], [a, b, eave], [a, 0, ridge], [a, -b, eave]),
  face("west", [-a, b, 0], [-a, -b, 0], [-a, -b, eave], [-a, 0, ridge], [-a, b, eave]),
  face("south", [-a, -b, 0], [a, -b, 0], [a, -b, eave], [-a, -b, eave]),
  face("north", [a, b, 0], [-a, b, 0], [-a, b, eave], [a, b, eave]),
];

function face(name: FaceName, ...corners: Vec3[]): Face {
  const [p, q, r] = corners as [Vec3, Vec3, Vec3];
  return { name, corners, normal: unit(cross(sub(q, p), sub(r, q))) };
}

/** Points that the lessons speak of. */
export const CORNERS = {
  southEaveWest: [-a, -b, eave] as Vec3,
  southEaveEast: [a, -b, eave] as Vec3,
  northEaveWest: [-a, b, eave] as Vec3,
  northEaveEast: [a, b, eave] as Vec3,
  ridgeWest: [-a, 0, ridge] as Vec3,
  ridgeEast: [a, 0, ridge] as Vec3,
};

export const SOUTH_EAVE = [CORNERS.southEaveWest, CORNERS.southEaveEast] as const;
export const RIDGE = [CORNERS.ridgeWest, CORNERS.ridgeEast] as const;

/** Lines of the house that are level, by their ends: what W96 looks for. */
export const EDGES: readonly (readonly [Vec3, Vec3])[] = [
  SOUTH_EAVE,
  [CORNERS.northEaveWest, CORNERS.northEaveEast],
  RIDGE,
  [CORNERS.southEaveWest, CORNERS.northEaveWest],
  [CORNERS.southEaveEast, CORNERS.northEaveEast],
];

/** The faces that a place sees. The house is convex, so no face hides another. */
function facesSeenFrom(place: Vec3): readonly Face[] {
  return FACES.filter(({ corners, normal }) => dot(normal, sub(place, corners[0] as Vec3)) > 0);
}

/** Cameras of a flight over it: 320 x 240 pixels of 8 cm, as B99's, reduced to what a drawing needs. */
export function aerial(C: Vec3, target: Vec3 = [0, 0, 5]): Camera {
  return { f: 450, cx: 160, cy: 120, width: 320, height: 240, C, R: lookingAt(C, target, [0, 1, 0]) };
}

/** Three views: two on one strip, one on the next. */
export const VIEWS: readonly [Camera, Camera, Camera] = [
  aerial([-9, -4, 42]),
  aerial([9, -4, 42]),
  aerial([1, 12, 43]),
];

/** Three views whose first baseline runs across the ridge: from those above, its planes would be the same. */
export const ACROSS: readonly [Camera, Camera, Camera] = [
  aerial([-7, -11, 42]),
  aerial([-4, 9, 42]),
  aerial([11, -1, 43]),
];

/** Where a face's own coordinates are, metres: along its first side, and up from it. */
function onFace({ corners, normal }: Face, X: Vec3): Vec2 {
  const [p, q] = corners as readonly [Vec3, Vec3];
  const along = unit(sub(q, p));
  return [dot(sub(X, p), along), dot(sub(X, p), cross(normal, along))];
}

function isInside({ corners, normal }: Face, X: Vec3): boolean {
  return corners.every((p, i) => {
    const q = corners[(i + 1) % corners.length] as Vec3;
    return dot(cross(sub(q, p), sub(X, p)), normal) >= -1e-9;
  });
}

/** A grey value that belongs to a whole number pair, 0 to 1. */
export function hash(x: number, y: number): number {
  let h = Math.imul(x | 0, 0x27d4eb2d) ^ Math.imul(y | 0, 0x165667b1);
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39);
  return ((h ^ (h >>> 15)) >>> 0) / 4294967296;
}

/** Smooth noise with a grain of one unit, 0 to 1. */
export function noise(x: number, y: number): number {
  const [i, j] = [Math.floor(x), Math.floor(y)];
  const [u, v] = [x - i, y - j].map((t) => t * t * (3 - 2 * t)) as [number, number];
  const row = (k: number) => hash(i, k) * (1 - u) + hash(i + 1, k) * u;
  return row(j) * (1 - v) + row(j + 1) * v;
}

export interface Look {
  /** How much texture the roof has, 0 to 1. */
  texture: number;
  /** Standard deviation of the camera's noise, grey values. */
  noise: number;
}

const USUAL: Look = { texture: 1, noise: 0 };

/** Grey value of a surface at a place of its own, 0 to 255. */
function greyOf(name: FaceName | "ground", [u, v]: Vec2, { texture }: Look): number {
  if (name === "ground") {
    const path = Math.abs(v + 9 + 0.15 * u) < 1 ? 60 : 0;
    return 84 + path + 34 * noise(0.8 * u, 0.8 * v) + 26 * noise(3.1 * u + 7, 3.1 * v);
  }
  if (name.endsWith("roof")) {
    const base = name === "south roof" ? 158 : 118;
    const course = Math.floor(v / 0.4);
    const tile = hash(Math.floor((u + 0.2 * (course % 2)) / 0.45), course + (base > 150 ? 0 : 91));
    const joint = v / 0.4 - course < 0.2 ? -22 : 0;
    const weather =
      70 * (noise(0.9 * u + 3, 0.9 * v + base) - 0.5) + 46 * (noise(2.2 * u, 2.2 * v + base) - 0.5);
    return base + texture * (44 * (tile - 0.5) + joint + weather);
  }
  const window = Math.abs(((u + 10) % 2.5) - 1.25) < 0.5 && v % 2.6 > 0.9 && v % 2.6 < 2.1 ? -90 : 0;
  return 205 + window;
}

export interface Picture {
  width: number;
  height: number;
  /** 0 to 255, row by row. */
  grey: Float32Array;
}

/** A photograph of the house, pixel by pixel: the nearest surface along the ray through the pixel's centre. */
export function photograph(camera: Camera, look: Look = USUAL): Picture {
  const { width, height, C } = camera;
  const grey = new Float32Array(width * height);
  const toRay = transpose(camera.R);
  const inverseK = inverse(calibration(camera));
  const seen = facesSeenFrom(C);
  for (let row = 0; row < height; row += 1) {
    for (let column = 0; column < width; column += 1) {
      const ray = apply3(toRay, apply3(inverseK, [column + 0.5, row + 0.5, 1]));
      // The same noise whenever this camera takes its photograph.
      const own = look.noise === 0 ? 0 : look.noise * noiseAt(column + 7919 * Math.round(C[0]), row);
      grey[row * width + column] = greyAlong(C, ray, seen, look) + own;
    }
  }
  return { width, height, grey };
}

/** About normal: three even numbers, scaled to a variance of 1. */
function noiseAt(x: number, y: number): number {
  return 2 * (hash(x, y) + hash(x, y + 4096) + hash(x, y + 8192) - 1.5);
}

function greyAlong(C: Vec3, ray: Vec3, seen: readonly Face[], look: Look): number {
  const { face: hit, X } = surfaceAlong(C, ray, seen);
  return hit === null ? greyOf("ground", [X[0], X[1]], look) : greyOf(hit.name, onFace(hit, X), look);
}

/** The nearest surface along a ray: one of the faces, or the ground. */
function surfaceAlong(C: Vec3, ray: Vec3, faces: readonly Face[]): { face: Face | null; X: Vec3 } {
  for (const one of faces) {
    const s = dot(one.normal, sub(one.corners[0] as Vec3, C)) / dot(one.normal, ray);
    const X = add(C, ray, s);
    if (s > 0 && isInside(one, X)) {
      return { face: one, X };
    }
  }
  return { face: null, X: add(C, ray, -C[2] / ray[2]) };
}

/** Grey value between pixels, bilinear; the nearest pixel beyond the margin. */
export function sample({ width, height, grey }: Picture, [x, y]: Vec2): number {
  const [px, py] = [
    Math.min(Math.max(x - 0.5, 0), width - 1.001),
    Math.min(Math.max(y - 0.5, 0), height - 1.001),
  ];
  const [i, j] = [Math.floor(px), Math.floor(py)];
  const [u, v] = [px - i, py - j];
  const at = (row: number, column: number) => grey[row * width + column] as number;
  return (
    (at(j, i) * (1 - u) + at(j, i + 1) * u) * (1 - v) + (at(j + 1, i) * (1 - u) + at(j + 1, i + 1) * u) * v
  );
}

/** The visible faces as a camera sees them, for drawings. */
export function facesIn(camera: Camera): readonly { face: Face; outline: readonly Vec2[] }[] {
  return facesSeenFrom(camera.C)
    .filter(({ corners }) => corners.every((X) => depthOf(camera, X) > 0.1))
    .map((one) => ({ face: one, outline: one.corners.map((X) => imageOf(camera, X)) }));
}

/** What is seen at an image point. */
export function surfaceAt(camera: Camera, x: Vec2): { name: FaceName | "ground"; X: Vec3 } {
  const { face: hit, X } = surfaceAlong(camera.C, rayOf(camera, x), facesSeenFrom(camera.C));
  return { name: hit?.name ?? "ground", X };
}

/**
 * The symbols of all lessons: one letter, one meaning, one colour, in text, formula and figure. Colours go by what a thing belongs to:
 * 1 the first view, 2 the second, 3 the third, 4 space, 5 cameras, 6 what the reader turns, 7 errors; 0 has none.
 */
import type { Glyph } from "../../app/words/formula";

export interface MathSymbol extends Glyph {
  means: string;
}

const vector = (glyph: string, colour: MathSymbol["colour"], means: string, sub?: string): MathSymbol => ({
  glyph,
  form: "vector",
  colour,
  means,
  ...(sub === undefined ? {} : { sub }),
});

const letter = (glyph: string, colour: MathSymbol["colour"], means: string, sub?: string): MathSymbol => ({
  ...vector(glyph, colour, means, sub),
  form: "letter",
});

const name = (glyph: string, colour: MathSymbol["colour"], means: string): MathSymbol => ({
  ...vector(glyph, colour, means),
  form: "name",
});

/** By the word that stands for each in formulas. */
export const SYMBOLS = {
  x: vector("x", 1, "image point in the first view, pixels; in products homogeneous, (x, y, 1)"),
  u: letter("x", 1, "image coordinate to the right, pixels"),
  v: letter("y", 1, "image coordinate downwards, pixels"),
  x2: vector("x′", 2, "image point in the second view"),
  l: vector("l", 1, "line in the first view, (a, b, c): its points have a x + b y + c = 0"),
  l2: vector("l′", 2, "line in the second view"),
  l3: vector("l″", 3, "line in the third view"),
  le: vector("l′", 2, "epipolar line of x in the second view", "e"),
  e2: vector("e′", 2, "epipole: the first projection centre, seen in the second view"),
  e1: vector("e", 1, "epipole: the second projection centre, seen in the first view"),
  X: vector("X", 4, "point in space, metres; in products homogeneous, (X, Y, Z, 1)"),
  L: letter("L", 4, "line in space"),
  W: letter("W", 4, "length of a roof, metres"),
  Z: letter("Z", 5, "depth before the camera, metres"),
  plane1: vector("π", 1, "plane of all points that are seen on l"),
  plane2: vector("π′", 2, "plane of all points that are seen on l′"),
  C: vector("C", 5, "projection centre of the first camera"),
  C2: vector("C′", 5, "projection centre of the second camera"),
  K: letter("K", 5, "calibration: principal distance and principal point"),
  R: letter("R", 5, "rotation from the world into the camera"),
  f: letter("f", 5, "principal distance, pixels"),
  cx: letter("c", 5, "principal point, to the right, pixels", "x"),
  cy: letter("c", 5, "principal point, downwards, pixels", "y"),
  P: letter("P", 5, "projection matrix of the first view, 3 × 4"),
  P2: letter("P′", 5, "projection matrix of the second view"),
  P3: letter("P″", 5, "projection matrix of the third view"),
  B: letter("B", 5, "baseline: distance of two projection centres, metres"),
  N: letter("N", 5, "number of views"),
  F: letter("F", 0, "fundamental matrix of the first and second view, 3 × 3, of rank 2"),
  tensor: letter("T", 0, "trifocal tensor: three matrices of 3 × 3"),
  H: letter("H", 6, "homography: image to image, by a plane"),
  A2: letter("A", 5, "first three columns of the second view's matrix, where the first is [I | 0]"),
  a2: vector("a", 5, "fourth column of the second view's matrix"),
  vn: vector("v", 4, "normal of the plane over its distance, with the sign that the formula needs"),
  h: letter("h", 6, "height above the ground, metres"),
  theta: letter("θ", 6, "angle of the half-plane against the horizontal"),
  alpha: letter("α", 6, "azimuth of the first main direction"),
  phi: letter("φ", 6, "angle in plan between the edge and the baseline"),
  w: letter("w", 0, "weight: the inverse of the distance from the line"),
  c: letter("c", 6, "correlation of two windows, −1 to 1"),
  I: letter("I", 1, "grey value of a window of the first view"),
  I2: letter("I′", 2, "grey value of a window of the second view"),
  gain: letter("g", 6, "contrast of the second view against the first"),
  offset: letter("b", 6, "brightness of the second view against the first"),
  mean1: name("Ī", 1, "mean grey value of the first window"),
  mean2: name("Ī′", 2, "mean grey value of the second window"),
  sigma: letter("σ", 7, "standard deviation of an image point, pixels"),
  sigmaZ: letter("σ", 7, "standard deviation of the depth, metres", "Z"),
  sigmaX: letter("Σ", 7, "covariance of the point in space, square metres"),
  J: letter("J", 0, "how the image point moves with the point in space, pixels a metre"),
  d: letter("d", 7, "distance in the image, pixels"),
  len: letter("ℓ", 1, "length in the image, pixels"),
  S: letter("S", 6, "confidence of a facet, square metres"),
  area: letter("𝒜", 4, "area of a facet, square metres"),
  tau: letter("τ", 6, "share of the outline that lies on reconstructed lines"),
  away: letter("D", 6, "distance from the eave in plan, metres"),
  z: letter("z", 4, "height, metres"),
  k: letter("k", 6, "number of breaks"),
  n: letter("n", 0, "number of pixels"),
  m: letter("m", 0, "number of lines in a view"),
  DL: name("DL", 6, "description length, bits"),
  sigmaG: letter("σ", 7, "standard deviation of the grey values' noise", "g"),
  r: letter("r", 7, "deviation of a pixel from its stretch's mean, grey values"),
  on: name("on", 4, "the window lies on the plane"),
  off: name("off", 7, "it does not"),
  p: letter("p", 0, "probability, or its density"),
  E: letter("E", 6, "evidence, nats: the logarithm of a likelihood ratio"),
  q: letter("q", 5, "probability that a view does not see the place"),
  zed: letter("t", 6, "contrast across an edge over its standard deviation"),
  mu: letter("μ", 4, "contrast that a true edge would have, in standard deviations"),
  Sim: name("Sim", 6, "similarity of the views on a half-plane, 0 to 1"),
  Cor: name("Cor", 6, "centred normalised cross-correlation of two windows"),
  i: letter("i", 0, "counts views, pixels or windows"),
} as const satisfies Record<string, MathSymbol>;

type SymbolName = keyof typeof SYMBOLS;

export function symbolOf(word: string): MathSymbol | null {
  return Object.hasOwn(SYMBOLS, word) ? SYMBOLS[word as SymbolName] : null;
}

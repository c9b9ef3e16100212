/** Planted configurations: random, but the same from the same seed. */
import { apply, crossMatrix, type Mat, scaled, times } from "../../shared/linear";
import { dehomogenised } from "./linear";

export type Random = () => number;

/** Numbers from 0 to 1 (mulberry32). */
export function randomFrom(seed: number): Random {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export function between(random: Random, low: number, high: number): number {
  return low + (high - low) * random();
}

/** From a normal distribution (Box and Muller). */
export function normal(random: Random): number {
  return Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
}

interface PlantedCamera {
  /** Focal length and principal point in pixels. */
  k: Mat;
  /** From the world to the camera: x right, y down, z forward. */
  r: Mat;
  /** R X + t. */
  t: number[];
  projection: Mat;
}

/** An aerial camera, some 100 m above the ground, turned any way about the vertical and a little tilted. */
export function plantedCamera(random: Random): PlantedCamera {
  const focal = between(random, 1500, 3000);
  const k = [
    [focal, 0, between(random, 350, 450)],
    [0, focal, between(random, 250, 350)],
    [0, 0, 1],
  ];
  const centre = [between(random, -30, 30), between(random, -30, 30), between(random, 90, 130)];
  const down = [
    [1, 0, 0],
    [0, -1, 0],
    [0, 0, -1],
  ];
  const tilt = () => between(random, 0.05, 0.15) * (random() < 0.5 ? -1 : 1);
  const [x, y] = [turn(0, tilt()), turn(1, tilt())];
  const r = times(x, times(y, times(down, turn(2, between(random, 0.3, 1.2)))));
  const t = scaled(apply(r, centre), -1);
  return { k, r, t, projection: projectionOf(k, r, t) };
}

/** K [R | t] */
function projectionOf(k: Mat, r: Mat, t: readonly number[]): Mat {
  return times(
    k,
    r.map((row, i) => [...row, t[i] ?? 0]),
  );
}

/** Where a point of the world is seen. */
export function seen(projection: Mat, point: readonly number[]): [number, number] {
  return dehomogenised(apply(projection, [...point, 1]));
}

/** On a roof or on the ground. */
export function plantedPoint(random: Random): [number, number, number] {
  return [between(random, -15, 15), between(random, -15, 15), between(random, 0, 12)];
}

/** The rotation about an axis: cos I + sin [a]x, and 1 where the axis meets itself. */
function turn(axis: 0 | 1 | 2, angle: number): Mat {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const across = crossMatrix([0, 0, 0].with(axis, s));
  return across.map((row, i) => row.with(i, i === axis ? 1 : c));
}

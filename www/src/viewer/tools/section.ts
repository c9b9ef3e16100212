/** A vertical cut through what is shown: the profile between two points, and what lies in front of it clipped away. */
import { Mesh, type Object3D, Plane, Vector3 } from "three";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { trianglesOf } from "../scene/layer";

/** Metres along the cut from its first point, and height in the viewer's frame, metres. */
type ProfilePoint = readonly [along: number, height: number];

/** A straight piece of the profile, from left to right. */
export interface ProfilePiece {
  from: ProfilePoint;
  to: ProfilePoint;
  /** Radians, positive where it rises; a right angle for a wall. */
  slope: number;
}

export interface Section {
  lengthM: number;
  pieces: readonly ProfilePiece[];
}

/** Pieces whose ends are nearer, metres, and whose slopes differ by less, radians, are one. */
const SAME_M = 2e-3;
const SAME_SLOPE = 2e-3;

/** The cut of all faces below an object with the vertical plane through two points, between these points. */
export function sectionOf(objects: readonly Object3D[], a: Vector3, b: Vector3): Section {
  const along = new Vector3(b.x - a.x, 0, b.z - a.z);
  const lengthM = along.length();
  if (!(lengthM > 0)) {
    return { lengthM: 0, pieces: [] };
  }
  along.divideScalar(lengthM);
  const across = new Vector3(-along.z, 0, along.x);
  const pieces = objects
    .flatMap(trianglesBelow)
    .map((corners) => cut(corners, a, along, across))
    .filter((piece) => piece !== null)
    .map((piece) => clipped(piece, lengthM))
    .filter((piece) => piece !== null);
  return { lengthM, pieces: joined(pieces) };
}

/** The plane that clips away what lies on the eye's side of the cut. */
export function clippingPlane(a: Vector3, b: Vector3, eye: Vector3): Plane {
  const across = new Vector3(a.z - b.z, 0, b.x - a.x).normalize();
  const plane = new Plane().setFromNormalAndCoplanarPoint(across, a);
  if (plane.distanceToPoint(eye) > 0) {
    plane.negate();
  }
  // The mark of the cut itself stays visible.
  plane.constant += 0.02;
  return plane;
}

type Corners = ReturnType<typeof trianglesOf>[number];

/** The triangles of all meshes below an object, in the viewer's frame. */
function trianglesBelow(object: Object3D): Corners[] {
  const found: Corners[] = [];
  object.updateWorldMatrix(true, true);
  object.traverse((child) => {
    // Lines of constant width are meshes, too.
    if (child instanceof Mesh && !(child instanceof LineSegments2)) {
      const own = trianglesOf(child.geometry);
      own.flat().forEach((corner) => void corner.applyMatrix4(child.matrixWorld));
      found.push(...own);
    }
  });
  return found;
}

/** Where a triangle crosses the plane; null where it does not, or lies in it. */
function cut(corners: Corners, a: Vector3, along: Vector3, across: Vector3): ProfilePiece | null {
  const away = corners.map((corner) => across.dot(corner) - across.dot(a));
  const ends: ProfilePoint[] = [];
  for (let i = 0; i < 3; i += 1) {
    const j = (i + 1) % 3;
    const [p, q] = [corners[i] as Vector3, corners[j] as Vector3];
    const [d, e] = [away[i] as number, away[j] as number];
    // A corner in the plane counts as beyond it, so that each crossing is found once.
    if (d < 0 !== e < 0) {
      const at = p.clone().lerp(q, d / (d - e));
      ends.push([along.dot(at) - along.dot(a), at.y]);
    }
  }
  const [from, to] = ends;
  return from === undefined || to === undefined ? null : pieceOf(from, to);
}

function pieceOf(p: ProfilePoint, q: ProfilePoint): ProfilePiece {
  const [from, to] = p[0] < q[0] || (p[0] === q[0] && p[1] < q[1]) ? [p, q] : [q, p];
  return { from, to, slope: Math.atan2(to[1] - from[1], to[0] - from[0]) };
}

/** The part of a piece between both ends of the cut. */
function clipped({ from, to, slope }: ProfilePiece, lengthM: number): ProfilePiece | null {
  const [low, high] = [Math.max(0, from[0]), Math.min(lengthM, to[0])];
  if (low > high || Math.hypot(to[0] - from[0], to[1] - from[1]) < SAME_M) {
    return null;
  }
  const at = (s: number): ProfilePoint =>
    to[0] === from[0] ? [s, from[1]] : [s, from[1] + ((s - from[0]) / (to[0] - from[0])) * (to[1] - from[1])];
  return to[0] === from[0] ? { from, to, slope } : { from: at(low), to: at(high), slope };
}

/** The triangles of a face give pieces that continue each other; a face may be shown twice, once more for being selected. */
function joined(pieces: readonly ProfilePiece[]): ProfilePiece[] {
  const key = ({ from, to }: ProfilePiece) => [...from, ...to].map((m) => Math.round(m / SAME_M)).join();
  const once = [...new Map(pieces.map((piece) => [key(piece), piece])).values()];
  once.sort((p, q) => p.from[0] - q.from[0] || p.from[1] - q.from[1]);
  const result: ProfilePiece[] = [];
  for (const piece of once) {
    const before = result.findIndex((one) => continues(one, piece));
    const one = result[before];
    if (one === undefined) {
      result.push(piece);
    } else {
      result[before] = pieceOf(one.from, piece.to);
    }
  }
  return result;
}

function continues(one: ProfilePiece, next: ProfilePiece): boolean {
  const gap = Math.hypot(one.to[0] - next.from[0], one.to[1] - next.from[1]);
  return gap < SAME_M && Math.abs(one.slope - next.slope) < SAME_SLOPE;
}

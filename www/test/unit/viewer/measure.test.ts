import { PerspectiveCamera, Raycaster, Vector2, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { type Corner, snapped } from "../../../src/viewer/tools/measure";

/** A face of four by four metres at height 5, seen from straight above; its first corner is known to 2 cm. */
const RING: Corner[] = [
  [-2, -2],
  [2, -2],
  [2, 2],
  [-2, 2],
].map(([x = 0, z = 0], i) => ({
  at: new Vector3(x, 5, z),
  sigma: i < 2 ? new Vector3(1, 1, 1).multiplyScalar(0.02) : null,
}));
const SIZE = { width: 800, height: 800 };

function camera(): PerspectiveCamera {
  const made = new PerspectiveCamera(50, 1, 0.1, 100);
  made.position.set(0, 20, 0);
  made.up.set(0, 0, -1);
  made.lookAt(0, 0, 0);
  made.updateMatrixWorld();
  return made;
}

/** What is taken so many pixels beside where a point is seen. */
function takenBeside(point: Vector3, px: number, seen: Vector3 | null = null) {
  const from = camera();
  const { x, y } = point.clone().project(from);
  const at = new Vector2(x + (2 * px) / SIZE.width, y);
  const caster = new Raycaster();
  caster.setFromCamera(at, from);
  return snapped({ at, ray: caster.ray, camera: from, size: SIZE }, [RING], seen);
}

describe("a point that is measured", () => {
  const [first, second, third] = RING.map(({ at }) => at) as [Vector3, Vector3, Vector3];
  it("is drawn to a corner, with its standard deviation, before an edge", () => {
    const taken = takenBeside(first, 8);
    expect([taken?.on, taken?.at, taken?.sigma?.x]).toEqual(["corner", first, 0.02]);
  });

  it("is drawn to an edge, of which as much is known as of both ends", () => {
    const middle = first.clone().lerp(second, 0.4);
    const taken = takenBeside(middle.clone().setZ(-2.05), 0);
    expect([taken?.on, taken?.sigma?.x]).toEqual(["edge", 0.02]);
    expect(taken?.at.distanceTo(middle)).toBeLessThan(0.05);
    expect(takenBeside(second.clone().lerp(third, 0.5), 3)?.sigma).toBeNull();
  });

  it("stays where it is far from both, or where these are hidden", () => {
    expect(takenBeside(new Vector3(0, 5, 0), 0)).toBeNull();
    expect(takenBeside(first, 8, new Vector3(-2, 9, -2))).toBeNull();
  });
});

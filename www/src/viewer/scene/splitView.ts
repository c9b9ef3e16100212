/** Two results side by side in one canvas, seen by the same camera. */
import { type Camera, type Object3D, type Scene, Vector2, type WebGLRenderer } from "three";

/** Draws the scene twice: in the left half without what belongs to the right one, and the reverse. */
export function drawHalves(
  renderer: WebGLRenderer,
  scene: Scene,
  camera: Camera,
  left: readonly Object3D[],
  right: readonly Object3D[],
): void {
  const { x, y } = renderer.getSize(new Vector2());
  renderer.setScissorTest(true);
  for (const [start, others] of [
    [0, right],
    [x / 2, left],
  ] as const) {
    const hidden = others.filter(({ visible }) => visible);
    setVisible(hidden, false);
    renderer.setViewport(start, 0, x / 2, y);
    renderer.setScissor(start, 0, x / 2, y);
    renderer.render(scene, camera);
    setVisible(hidden, true);
  }
  renderer.setScissorTest(false);
  renderer.setViewport(0, 0, x, y);
}

function setVisible(objects: readonly Object3D[], visible: boolean): void {
  for (const object of objects) {
    object.visible = visible;
  }
}

/** A place of the canvas in clip space; where the canvas is halved, in that of the half that it lies in, and which one it is. */
export function clipPlace(
  { x, y }: { x: number; y: number },
  { width, height }: { width: number; height: number },
  halved: boolean,
): { at: Vector2; side: "left" | "right" | null } {
  const wide = halved ? width / 2 : width;
  const isRight = halved && x >= wide;
  const at = new Vector2(((isRight ? x - wide : x) / wide) * 2 - 1, 1 - (y / height) * 2);
  return { at, side: halved ? (isRight ? "right" : "left") : null };
}

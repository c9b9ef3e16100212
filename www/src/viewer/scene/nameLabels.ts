/** Names in space: text of constant size on the screen, over whatever lies before it. */
import { CanvasTexture, Group, Sprite, SpriteMaterial, SRGBColorSpace, Vector2 } from "three";
import type { Vec3 } from "../../shared/records";

interface NamedPlace {
  text: string;
  at: Vec3;
}

/** More names than these are not read: the first ones are drawn. */
const MOST_NAMES = 40;
const FONT_PX = 13;
const PADDING_PX = 3;
/** The picture is finer than the screen's pixels by this. */
const SHARPNESS = 2;

export function nameLabels(names: readonly NamedPlace[]): Group {
  const group = new Group();
  // Where there is no canvas, as in unit tests, nothing is written.
  if (typeof OffscreenCanvas !== "undefined" && names.length > 0) {
    group.add(...names.slice(0, MOST_NAMES).map(label));
  }
  return group;
}

function label({ text, at }: NamedPlace): Sprite {
  const canvas = new OffscreenCanvas(1, 1);
  const font = `600 ${FONT_PX * SHARPNESS}px system-ui, sans-serif`;
  const measuring = canvas.getContext("2d") as OffscreenCanvasRenderingContext2D;
  measuring.font = font;
  canvas.width = Math.ceil(measuring.measureText(text).width) + 2 * PADDING_PX * SHARPNESS;
  canvas.height = (FONT_PX + 2 * PADDING_PX) * SHARPNESS;
  const context = canvas.getContext("2d") as OffscreenCanvasRenderingContext2D;
  context.fillStyle = "rgb(20 23 28 / 80%)";
  context.roundRect(0, 0, canvas.width, canvas.height, PADDING_PX * SHARPNESS);
  context.fill();
  context.font = font;
  context.fillStyle = "#fff";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(text, canvas.width / 2, canvas.height / 2);
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false, sizeAttenuation: false }));
  sprite.position.set(...at);
  sprite.renderOrder = 4;
  sprite.raycast = () => undefined;
  // As large in a low canvas as in a high one.
  sprite.onBeforeRender = (renderer, _scene, camera) => {
    const shown = renderer.getSize(new Vector2()).y * Math.abs(camera.projectionMatrix.elements[5] ?? 1);
    const perPx = 2 / (SHARPNESS * shown);
    sprite.scale.set(perPx * canvas.width, perPx * canvas.height, 1);
    sprite.updateMatrixWorld();
  };
  return sprite;
}

/** The entrance's picture: a finished model on its photograph, which turns slowly until a hand takes it. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Scene,
  SRGBColorSpace,
  type Texture,
  TextureLoader,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { daylight, disposeObject } from "./scene/layer";

/** What the build wrote of the ground: points of it, row by row of a photograph, in the viewer's frame. */
export interface PhotographicGround {
  photograph: string;
  /** Cells a side. */
  cells: number;
  /** x, y, z of each point, metres. */
  corners: readonly number[];
}

export interface Turntable {
  setBackground(colour: number | string): void;
  dispose(): void;
}

const FIELD_OF_VIEW_DEG = 30;
const SECONDS_A_TURN = 70;
/** Often enough for a slow turn; software graphics leave the rest to the page. */
const FRAME_MS = 1000 / 30;
/** Of the ground's half width that is looked at: its corners may leave the picture as it turns. */
const SHOWN_SHARE = 0.92;

/** Shows the model on its ground; `turns` says whether it moves by itself. */
export async function createTurntable(
  canvas: HTMLCanvasElement,
  model: ArrayBuffer,
  ground: PhotographicGround,
  photographUrl: string,
  turns: boolean,
): Promise<Turntable> {
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  const scene = new Scene();
  const [{ scene: buildings }, texture] = await Promise.all([
    new GLTFLoader().parseAsync(model, ""),
    new TextureLoader().loadAsync(photographUrl),
  ]);
  const floor = groundMesh(ground, texture, renderer.capabilities.getMaxAnisotropy());
  scene.add(buildings, floor, ...daylight());
  const camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 1, 1000);
  const controls = new OrbitControls(camera, canvas);
  controls.enablePan = false;
  controls.enableZoom = false;
  controls.minPolarAngle = 0.2 * Math.PI;
  controls.maxPolarAngle = 0.42 * Math.PI;
  controls.autoRotate = turns;
  controls.autoRotateSpeed = 60 / SECONDS_A_TURN;
  // A finger that moves up or down scrolls the page.
  canvas.style.touchAction = "pan-y";
  controls.addEventListener("start", () => {
    controls.autoRotate = false;
  });
  floor.geometry.computeBoundingSphere();
  const { center, radius } = floor.geometry.boundingSphere ?? { center: new Vector3(), radius: 30 };
  controls.target.copy(center).add(new Vector3(0, -0.5, 0));

  /** The whole ground in the picture, whatever its shape. */
  const fit = () => {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0 || height === 0) {
      return;
    }
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    const upright = (FIELD_OF_VIEW_DEG * Math.PI) / 360;
    const level = Math.atan(Math.tan(upright) * camera.aspect);
    // Seen at a slant the ground is lower than wide.
    const distance = SHOWN_SHARE * Math.max(radius / Math.tan(level), (0.72 * radius) / Math.tan(upright));
    const towards = camera.position.lengthSq() === 0 ? new Vector3(-0.5, 0.62, 0.6) : towardsCamera();
    camera.position.copy(controls.target).addScaledVector(towards.normalize(), distance);
    controls.update();
    renderer.render(scene, camera);
  };
  const towardsCamera = () => camera.position.clone().sub(controls.target);
  const observer = new ResizeObserver(fit);
  observer.observe(canvas);
  controls.addEventListener("change", () => {
    if (!controls.autoRotate) {
      renderer.render(scene, camera);
    }
  });

  let last = performance.now();
  let frame = requestAnimationFrame(function turn(now) {
    frame = requestAnimationFrame(turn);
    if (controls.autoRotate && now - last >= FRAME_MS) {
      controls.update((now - last) / 1000);
      renderer.render(scene, camera);
      last = now;
    }
  });

  return {
    setBackground(colour) {
      scene.background = new Color(colour);
      renderer.render(scene, camera);
    },
    dispose() {
      cancelAnimationFrame(frame);
      observer.disconnect();
      controls.dispose();
      disposeObject(buildings);
      disposeObject(floor);
      texture.dispose();
      renderer.dispose();
      // Browsers allow few at a time, and the viewer has one, too.
      renderer.forceContextLoss();
    },
  };
}

function groundMesh({ cells, corners }: PhotographicGround, texture: Texture, anisotropy: number): Mesh {
  const across = cells + 1;
  const uv = Array.from({ length: across * across }, (_, i) => [
    (i % across) / cells,
    1 - Math.floor(i / across) / cells,
  ]);
  const triangles = Array.from({ length: cells * cells }, (_, i) => {
    const a = Math.floor(i / cells) * across + (i % cells);
    return [a, a + across, a + 1, a + 1, a + across, a + across + 1];
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(corners), 3));
  geometry.setAttribute("uv", new BufferAttribute(Float32Array.from(uv.flat()), 2));
  geometry.setIndex(triangles.flat());
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = anisotropy;
  return new Mesh(geometry, new MeshBasicMaterial({ map: texture, side: DoubleSide }));
}

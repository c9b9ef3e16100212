/** One WebGL view: orbit, pick, layers. Draws when something changed, not all the time. */
import {
  Box3,
  Color,
  type Object3D,
  PerspectiveCamera,
  Plane,
  Raycaster,
  Scene,
  Sphere,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { ThemeColours } from "../shared/palette";
import type { Vec3, ViewInfo } from "../shared/records";
import type { Selection, Standpoint } from "../shared/selection";
import { isNearlySame, ROOM, standFor } from "./scene/bounds";
import { yUp, zUp } from "./scene/frame";
import { gpuFinished } from "./scene/gpuFence";
import { buildGrid } from "./scene/grid";
import { daylight, type Layer } from "./scene/layer";
import { type LayerRoles, OF_BOTH_HALVES } from "./scene/layerRoles";
import { clipFromViewer } from "./scene/photoProjection";
import { clipPlace, drawHalves } from "./scene/splitView";
import { buildHandles, dragged, handleAt } from "./tools/handles";
import { buildMeasure, type Corner, type Measured, measure, snapped, type Taken } from "./tools/measure";
import { PressWatch } from "./tools/press";
import { clippingPlane, type Section, sectionOf } from "./tools/section";

const FIELD_OF_VIEW_DEG = 35;
const PAPER = 0xffffff;
const PICK_REACH_PX = 7;
/** From the south-west, as from a low aeroplane. */
const FIRST_LOOK = new Vector3(-0.45, 0.72, 0.62).normalize();

export class Viewer {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 0.5, 1e5);
  readonly #controls: OrbitControls;
  readonly #layers = new Map<string, Layer>();
  /** Layers that are not shown, whether they exist yet or not. */
  readonly #hidden = new Set<string>();
  /** Layers whose shaders are not ready yet. */
  readonly #compiling = new Set<Layer>();
  readonly #observer: ResizeObserver;
  readonly #roles: LayerRoles;
  readonly #onPick: (selection: Selection | null) => void;
  /** Whether the canvas keeps the pixels that it has. */
  #holdsSize = false;
  #colours: ThemeColours;
  #bounds: Sphere | null = null;
  #frame = 0;
  /** The plane of the section. */
  #cut: Plane | null = null;
  /** The view whose camera is looked through; null for the free one. */
  #photo: ViewInfo | null = null;
  /** Layers of the left half; null while the canvas is whole. */
  #left: ReadonlySet<string> | null = null;
  /** The points that were clicked for a tool; null while clicks pick. */
  #points: Vector3[] | null = null;
  #onPoint: (points: Vector3[], last: Taken) => void = () => undefined;
  /** Of the facets, by their corners: points are drawn to them. */
  #rings: readonly (readonly Corner[])[] = [];
  /** Dots that can be dragged, and the one that is being dragged. */
  #handles: readonly Vector3[] = [];
  #onDrop: (index: number, to: Vec3) => void = () => undefined;
  #held: { index: number; to: Vector3 } | null = null;

  /** Hears where the camera stands once a person has moved it. */
  onStand: (standpoint: Standpoint) => void = () => undefined;

  constructor(
    canvas: HTMLCanvasElement,
    colours: ThemeColours,
    onPick: (selection: Selection | null) => void,
    roles: LayerRoles = { picked: [], measured: [], cut: [] },
  ) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true });
    // Asking for errors waits for the compiler: seconds where graphics are computed in software.
    this.#renderer.debug.checkShaderErrors = import.meta.env.DEV;
    this.#onPick = onPick;
    this.#roles = roles;
    this.#colours = colours;
    this.#scene.add(...daylight());
    this.#camera.position.set(40, 50, 60);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.maxPolarAngle = 0.495 * Math.PI;
    this.#controls.listenToKeyEvents(canvas);
    this.#controls.addEventListener("change", () => this.draw());
    this.#controls.addEventListener("end", () => this.onStand(this.#standpoint()));
    // Before the controls hear of it.
    canvas.addEventListener("pointerdown", (event) => this.#takeHandle(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.#dragHandle(event));
    canvas.addEventListener("pointerup", () => this.#dropHandle());
    canvas.addEventListener("pointercancel", () => this.#dropHandle());
    const watch = new PressWatch((at) => this.press(at));
    for (const what of ["down", "move", "up", "cancel"] as const) {
      canvas.addEventListener(`pointer${what}`, (event) => watch[what](event));
    }
    this.#observer = new ResizeObserver(() => void this.#resize());
    this.#observer.observe(canvas);
    this.setTheme(colours);
  }

  /**
   * While it holds, the canvas keeps its pixels, and what is drawn is stretched to the canvas: pixels anew are waited for, up to
   * a second where graphics are computed in software beside a busy pipeline.
   */
  holdSize(holds: boolean): void {
    this.#holdsSize = holds;
    void this.#resize();
  }

  /** The pixels to begin with, before the canvas is seen. */
  prepareSize(width: number, height: number): void {
    this.#renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.#renderer.setSize(width, height, false);
  }

  /** Puts a layer in place of the one of this name, if any. */
  setLayer(name: string, layer: Layer | null): void {
    const old = this.#layers.get(name);
    if (old !== undefined) {
      this.#scene.remove(old.object);
      this.#layers.delete(name);
    }
    if (layer === null) {
      old?.dispose();
    } else {
      layer.object.visible = false;
      this.#layers.set(name, layer);
      this.#scene.add(layer.object);
      void this.#compile(name, layer, old);
    }
    this.draw();
  }

  /**
   * Shows a layer once its shaders are ready: drawing it earlier would wait for them. The layer that it replaces goes only
   * then, because the last material of a kind takes its shader along.
   */
  async #compile(name: string, layer: Layer, old: Layer | undefined): Promise<void> {
    this.#compiling.add(layer);
    await this.#renderer.compileAsync(layer.object, this.#camera, this.#scene);
    await gpuFinished(this.#renderer.getContext() as WebGL2RenderingContext);
    this.#learnPrograms();
    this.#compiling.delete(layer);
    old?.dispose();
    if (this.#layers.get(name) === layer) {
      this.showLayer(name, !this.#hidden.has(name));
    }
  }

  /** Asks for what the first picture would ask each shader for, while no other picture has to be waited for. */
  #learnPrograms(): void {
    for (const program of this.#renderer.info.programs ?? []) {
      if ((program as unknown as { isReady(): boolean }).isReady()) {
        program.getUniforms();
        program.getAttributes();
      }
    }
  }

  showLayer(name: string, visible: boolean): void {
    this.#hidden.delete(name);
    if (!visible) {
      this.#hidden.add(name);
    }
    const layer = this.#layers.get(name);
    if (layer !== undefined) {
      layer.object.visible = visible && !this.#compiling.has(layer);
      this.draw();
    }
  }

  /** Halves the canvas: these layers are seen in the left half, all others but those of the place itself in the right one. */
  halve(left: readonly string[] | null): void {
    this.#left = left === null ? null : new Set(left);
    this.draw();
  }

  highlight(selection: Selection | null): void {
    for (const layer of this.#layers.values()) {
      layer.highlight(selection);
    }
    this.draw();
  }

  setTheme(colours: ThemeColours): void {
    this.#colours = colours;
    this.#scene.background = new Color(colours.background);
    this.#buildGrid();
    this.draw();
  }

  /** Looks at points so that they fill the canvas, and lays the grid below them. */
  lookAt(points: readonly Vector3[]): void {
    this.#bounds = new Box3().setFromPoints([...points]).getBoundingSphere(new Sphere());
    this.#takeAspect();
    const upright = Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360) / ROOM;
    const stand = standFor(points, FIRST_LOOK, [upright * this.#camera.aspect, upright]);
    this.#controls.target.copy(stand.target);
    this.#camera.position.copy(stand.position);
    this.#controls.update();
    this.#buildGrid();
    this.draw();
  }

  /** As `lookAt`; where a look at nearly the same has been taken, the camera stays. */
  keepLookingAt(points: readonly Vector3[]): void {
    const next = new Box3().setFromPoints([...points]).getBoundingSphere(new Sphere());
    if (this.#bounds !== null && isNearlySame(this.#bounds, next)) {
      this.#bounds = next;
      this.#buildGrid();
      this.draw();
    } else {
      this.lookAt(points);
    }
  }

  /** Straight down, north up. */
  lookDown(): void {
    const distance = this.#camera.position.distanceTo(this.#controls.target);
    this.#camera.position.copy(this.#controls.target).add(new Vector3(0, distance, 1e-3 * distance));
    this.#controls.update();
    this.onStand(this.#standpoint());
    this.draw();
  }

  /** Puts the camera where it stood. */
  standAt([x, y, z, toX, toY, toZ]: Standpoint): void {
    this.#camera.position.copy(yUp([x, y, z]));
    this.#controls.target.copy(yUp([toX, toY, toZ]));
    this.#controls.update();
    this.draw();
  }

  #standpoint(): Standpoint {
    return [...zUp(this.#camera.position), ...zUp(this.#controls.target)];
  }

  /** Looks through a view's own camera, or freely again. */
  lookThrough(view: ViewInfo | null): void {
    this.#photo = view;
    this.#controls.enabled = view === null;
    if (view === null) {
      this.#camera.matrixWorldAutoUpdate = true;
      this.#controls.update();
    }
    this.draw();
  }

  /** From now on clicks measure, drawn to the corners and edges of these rings, until it is called with null. */
  measure(
    onMeasure: ((measured: Measured, last: Taken) => void) | null,
    rings: readonly (readonly Corner[])[] = [],
  ): void {
    this.#collect(onMeasure && ((points, last) => onMeasure(measure(points), last)));
    this.#rings = rings;
  }

  /** From now on every second click makes a vertical cut, until it is called with null. */
  section(onSection: ((section: Section | null) => void) | null): void {
    if (onSection === null) {
      this.clip("none");
      return;
    }
    this.#collect((points) => {
      if (points.length > 2) {
        points.splice(0, 2);
      }
      const [a, b] = points;
      this.clip("none");
      if (a === undefined || b === undefined) {
        onSection(null);
        return;
      }
      this.#cut = clippingPlane(a, b, this.#camera.position);
      this.#renderer.clippingPlanes = [this.#cut];
      onSection(sectionOf(this.#shown(this.#roles.cut), a, b));
    });
  }

  /** From now on clicks give points, local frame, until it is called with null. */
  draw3d(onPoint: ((point: Vec3) => void) | null): void {
    this.#collect(onPoint && ((points) => onPoint(zUp(points.splice(0)[0] as Vector3))));
  }

  /** Shows dots, local frame, that can be dragged; `onDrop` hears which, and where it was left. */
  showHandles(handles: readonly Vec3[], onDrop: (index: number, to: Vec3) => void): void {
    this.#handles = handles.map(yUp);
    this.#onDrop = onDrop;
    this.setLayer("handles", handles.length === 0 ? null : buildHandles(this.#handles));
  }

  #takeHandle(event: PointerEvent): void {
    const { clientWidth: width, clientHeight: height } = this.#renderer.domElement;
    if (this.#points !== null || this.#photo !== null || this.#left !== null || event.button !== 0) {
      return;
    }
    const { at } = clipPlace({ x: event.offsetX, y: event.offsetY }, { width, height }, false);
    const index = handleAt(at, this.#handles, this.#camera, { width, height });
    const from = this.#handles[index];
    if (from !== undefined) {
      this.#held = { index, to: from };
      this.#controls.enabled = false;
    }
  }

  #dragHandle(event: PointerEvent): void {
    const held = this.#held;
    if (held === null) {
      return;
    }
    const { clientWidth: width, clientHeight: height } = this.#renderer.domElement;
    const { at } = clipPlace({ x: event.offsetX, y: event.offsetY }, { width, height }, false);
    const from = this.#handles[held.index] as Vector3;
    held.to = dragged(from, this.#caster(at).ray, event.shiftKey) ?? held.to;
    const shown = this.#handles.map((handle, i) => (i === held.index ? held.to : handle));
    this.setLayer("handles", buildHandles(shown));
  }

  #dropHandle(): void {
    const held = this.#held;
    if (held !== null) {
      this.#held = null;
      this.#controls.enabled = true;
      if (held.to !== this.#handles[held.index]) {
        this.#onDrop(held.index, zUp(held.to));
      }
    }
  }

  /** Shows what the cut hides, or the other side of it. */
  clip(side: "none" | "other"): void {
    if (side === "other") {
      this.#cut?.negate();
    }
    this.#renderer.clippingPlanes = side === "none" || this.#cut === null ? [] : [this.#cut];
    this.draw();
  }

  #collect(onPoint: ((points: Vector3[], last: Taken) => void) | null): void {
    this.#rings = [];
    this.#points = onPoint === null ? null : [];
    this.#onPoint = onPoint ?? (() => undefined);
    this.setLayer("measure", null);
  }

  /** The objects of layers that are shown. */
  #shown(names: readonly string[]): Object3D[] {
    const objects = names.map((name) => this.#layers.get(name)?.object);
    return objects.filter((object) => object?.visible === true) as Object3D[];
  }

  /** The present picture as a PNG. */
  screenshot(): Promise<Blob | null> {
    this.#takeSize();
    this.#render();
    return new Promise((resolve) => this.#renderer.domElement.toBlob(resolve, "image/png"));
  }

  /** Draws the present picture on a plain canvas, on white: browsers print what WebGL drew last, or nothing. */
  printOn(paper: HTMLCanvasElement): void {
    const { domElement } = this.#renderer;
    const onScreen = this.#scene.background;
    this.#scene.background = new Color(PAPER);
    this.#render();
    this.#scene.background = onScreen;
    paper.width = domElement.width;
    paper.height = domElement.height;
    paper.getContext("2d")?.drawImage(domElement, 0, 0);
    this.draw();
  }

  draw(): void {
    if (this.#frame === 0) {
      this.#frame = requestAnimationFrame(() => this.#render());
    }
  }

  dispose(): void {
    cancelAnimationFrame(this.#frame);
    this.#observer.disconnect();
    for (const name of [...this.#layers.keys()]) {
      this.setLayer(name, null);
    }
    cancelAnimationFrame(this.#frame);
    this.#controls.dispose();
    this.#renderer.dispose();
  }

  #render(): void {
    this.#frame = 0;
    // What nobody sees costs nothing: once it is shown, the observer of its size has it drawn.
    if (this.#renderer.domElement.clientWidth === 0) {
      return;
    }
    const distance = this.#camera.position.distanceTo(this.#controls.target);
    this.#camera.near = Math.max(0.1, distance / 200);
    this.#camera.far = Math.max(5000, distance * 20);
    this.#takeAspect();
    this.#camera.updateProjectionMatrix();
    if (this.#photo !== null) {
      this.#usePhotoCamera(this.#photo);
    }
    if (this.#left === null) {
      this.#renderer.render(this.#scene, this.#camera);
    } else {
      const [left, right] = [this.#objectsOf("left"), this.#objectsOf("right")];
      drawHalves(this.#renderer, this.#scene, this.#camera, left, right);
    }
  }

  /** The shape of what the camera fills: of the canvas, or of half of it. */
  #takeAspect(): void {
    const { clientWidth, clientHeight } = this.#renderer.domElement;
    if (clientWidth > 0 && clientHeight > 0) {
      this.#camera.aspect = clientWidth / clientHeight / (this.#left === null ? 1 : 2);
    }
  }

  /** The objects that belong to one half. */
  #objectsOf(side: "left" | "right"): Object3D[] {
    return this.#shown([...this.#layers.keys()].filter((name) => this.#sideOf(name) === side));
  }

  #sideOf(name: string): "left" | "right" | null {
    return this.#left === null || OF_BOTH_HALVES.has(name) ? null : this.#left.has(name) ? "left" : "right";
  }

  /** The whole map from the viewer's frame to clip space goes into the projection; the camera itself stands at the origin. */
  #usePhotoCamera(view: ViewInfo): void {
    const depth = yUp(view.center).distanceTo(this.#controls.target);
    this.#camera.matrixWorldAutoUpdate = false;
    this.#camera.matrixWorld.identity();
    this.#camera.matrixWorldInverse.identity();
    this.#camera.projectionMatrix.copy(clipFromViewer(view, this.#camera.aspect, 0.2 * depth, 2 * depth));
    this.#camera.projectionMatrixInverse.copy(this.#camera.projectionMatrix).invert();
  }

  async #resize(): Promise<void> {
    // Setting any size waits for what the graphics card has to do.
    if (this.#wantsSize()) {
      await gpuFinished(this.#renderer.getContext() as WebGL2RenderingContext);
    }
    if (this.#wantsSize()) {
      this.#takeSize();
    }
    const { clientWidth, clientHeight } = this.#renderer.domElement;
    if (clientWidth > 0 && clientHeight > 0) {
      cancelAnimationFrame(this.#frame);
      this.#render();
    }
  }

  /** Setting the size that it has would make the canvas anew, too. */
  #wantsSize(): boolean {
    const { clientWidth, clientHeight } = this.#renderer.domElement;
    const { x, y } = this.#renderer.getSize(new Vector2());
    const isSeen = clientWidth > 0 && clientHeight > 0;
    return isSeen && !this.#holdsSize && (x !== clientWidth || y !== clientHeight);
  }

  #takeSize(): void {
    const { clientWidth, clientHeight } = this.#renderer.domElement;
    this.prepareSize(clientWidth, clientHeight);
  }

  /** Picks at a place of the canvas, CSS pixels, or gives the tool a point. */
  press(place: { x: number; y: number }): void {
    const { clientWidth: width, clientHeight: height } = this.#renderer.domElement;
    const { at, side } = clipPlace(place, { width, height }, this.#left !== null);
    if (this.#points !== null) {
      const names = this.#roles.measured.filter((name) => this.#sideOf(name) === side);
      this.#pointAt(at, this.#points, names);
    } else if (side !== "left") {
      this.#onPick(this.#pickAt(at));
    }
  }

  /** A point of what is shown, or of the ground beside it. */
  #pointAt(at: Vector2, points: Vector3[], names: readonly string[]): void {
    const caster = this.#caster(at);
    const hits = this.#shown(names).flatMap((object) => caster.intersectObject(object, true));
    const [hit] = hits.sort((a, b) => a.distance - b.distance);
    const floor = new Plane(new Vector3(0, 1, 0), -this.#floor());
    // On a line of constant width the hit lies beside it.
    const seen = hit?.pointOnLine ?? hit?.point ?? null;
    const point = seen ?? caster.ray.intersectPlane(floor, new Vector3());
    const { clientWidth, clientHeight: height } = this.#renderer.domElement;
    const size = { width: this.#left === null ? clientWidth : clientWidth / 2, height };
    const place = { at, ray: caster.ray, camera: this.#camera, size };
    const plain: Taken | null = point && { at: point, on: seen === null ? "ground" : "face", sigma: null };
    const last = snapped(place, this.#rings, seen) ?? plain;
    if (last !== null) {
      points.push(last.at.clone());
      this.#onPoint(points, last);
      this.setLayer("measure", buildMeasure(points));
    }
  }

  /** Thin things first: a line is picked even where a facet is in front of it by a hair. */
  #pickAt(at: Vector2): Selection | null {
    const caster = this.#caster(at);
    for (const name of this.#roles.picked) {
      const layer = this.#layers.get(name);
      const hit = layer?.object.visible ? caster.intersectObject(layer.object, true)[0] : undefined;
      const selection = hit === undefined ? null : (layer?.pick(hit) ?? null);
      if (selection !== null) {
        return selection;
      }
    }
    return null;
  }

  /** A ray through a place of the canvas, with the reach of a finger about thin things. */
  #caster(at: Vector2): Raycaster {
    const caster = new Raycaster();
    caster.setFromCamera(at, this.#camera);
    if (this.#photo !== null) {
      const far = new Vector3(at.x, at.y, 1).applyMatrix4(this.#camera.projectionMatrixInverse);
      const centre = yUp(this.#photo.center);
      caster.set(centre, far.sub(centre).normalize());
    }
    const distance = this.#camera.position.distanceTo(this.#controls.target);
    const metresPerPx =
      (2 * distance * Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360)) / this.#renderer.domElement.clientHeight;
    caster.params.Line.threshold = PICK_REACH_PX * metresPerPx;
    caster.params.Points.threshold = 2 * PICK_REACH_PX * metresPerPx;
    (caster.params as { Line2?: { threshold: number } }).Line2 = { threshold: PICK_REACH_PX };
    return caster;
  }

  #buildGrid(): void {
    if (this.#bounds !== null) {
      this.setLayer("grid", buildGrid(this.#bounds, this.#floor(), this.#colours.grid));
    }
  }

  /** The lowest point of the model, or the bottom of the sphere while there is none. */
  #floor(): number {
    const model = this.#layers.get("model");
    if (model !== undefined) {
      return new Box3().setFromObject(model.object).min.y - 0.02;
    }
    return (this.#bounds?.center.y ?? 0) - 0.35 * (this.#bounds?.radius ?? 0);
  }
}

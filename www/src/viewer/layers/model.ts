/** The textured model, read from the very GLB that can be downloaded. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  EdgesGeometry,
  Group,
  type Intersection,
  LineBasicMaterial,
  LineSegments,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  type Object3D,
  Triangle,
  Vector3,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { PALETTE, type ThemeColours } from "../../shared/palette";
import { indexOf, type Selection } from "../../shared/selection";
import { BEHIND_LINES, disposeObject, type Layer, SelectedObject, trianglesOf } from "../scene/layer";
import { normalTint } from "./facets";

export type ModelMode = "textured" | "plain" | "wireframe" | "normals" | "method" | "sun";

export interface ModelLayer extends Layer {
  setMode(mode: ModelMode): void;
  /** Colours of facets, for the modes that paint them. */
  setFacetColours(colours: readonly string[]): void;
  setTheme(colours: ThemeColours): void;
  /** Whether what stands on the roofs is there. */
  showObstructions(shows: boolean): void;
}

const DIMMED = new Color(0.45, 0.45, 0.45);
/** Edges where the faces on both sides differ by less are not drawn, degrees. */
const EDGE_ANGLE_DEG = 2;
const TASK_MS = 12;

/** The model of a GLB file, textured at first. */
export async function buildModel(glb: Uint8Array<ArrayBuffer>): Promise<ModelLayer> {
  const bytes = glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.byteLength);
  const { scene } = await new GLTFLoader().parseAsync(bytes, "");
  const object = new Group();
  object.add(scene);
  const meshes: Mesh[] = [];
  scene.traverse((child) => {
    if (child instanceof Mesh) {
      meshes.push(child);
    }
  });
  const textured = new Map(meshes.map((mesh) => [mesh, mesh.material as Material]));
  // What stands on roofs has no photograph: a dark one's material needs no program of its own.
  const standing = meshes.filter((mesh) => extra(mesh, "surface") === "obstruction");
  for (const mesh of standing) {
    const dark = (textured.get(meshes[0] as Mesh) as MeshBasicMaterial).clone();
    dark.color.multiplyScalar(0.4);
    textured.get(mesh)?.dispose();
    textured.set(mesh, dark);
    mesh.material = dark;
  }
  const own = [...new Set(textured.values())] as MeshBasicMaterial[];
  const colours = new Map(own.map((material) => [material, material.color.clone()]));
  await inShortTasks(meshes, addTint);
  const normals = new MeshBasicMaterial({ vertexColors: true, ...BEHIND_LINES });
  const plain = clay();
  const painted = new Map<string, Material>();
  let facetColours: readonly string[] = [];
  const paintOf = (mesh: Mesh) => {
    const colour = facetColours[indexIn(mesh, "facet") ?? -1];
    if (colour === undefined) {
      return plain;
    }
    const paint = painted.get(colour) ?? clay(colour);
    painted.set(colour, paint);
    return paint;
  };
  const hidden = new MeshBasicMaterial(BEHIND_LINES);
  const positions: number[] = [];
  await inShortTasks(meshes, (mesh) => positions.push(...edgePositions(mesh)));
  const edges = edgeLines(positions);
  object.add(edges);
  const marker = new SelectedObject(object);

  return {
    object,
    pick: describeHit,
    highlight(selection: Selection | null) {
      const isChosen = (mesh: Mesh) => matches(mesh, selection);
      const chosen = meshes.filter(isChosen);
      for (const [material, colour] of colours) {
        const tint = chosen.length > 0 ? DIMMED : new Color(1, 1, 1);
        material.color.copy(colour).multiply(tint);
      }
      marker.show(chosen.length === 0 ? null : markerOf(chosen));
    },
    setMode(mode: ModelMode) {
      const of: Record<ModelMode, (mesh: Mesh) => Material> = {
        textured: (mesh) => textured.get(mesh) as Material,
        plain: () => plain,
        wireframe: () => hidden,
        normals: () => normals,
        method: paintOf,
        sun: paintOf,
      };
      for (const mesh of meshes) {
        mesh.material = of[mode](mesh);
      }
      edges.visible = mode !== "textured";
    },
    showObstructions(shows: boolean) {
      for (const mesh of standing) {
        mesh.visible = shows;
      }
    },
    setFacetColours(colours: readonly string[]) {
      facetColours = colours;
    },
    setTheme(colours: ThemeColours) {
      plain.color.set(colours.clay);
      hidden.color.set(colours.background);
      edges.material.color.set(colours.ink);
    },
    dispose() {
      for (const material of [...textured.values(), normals, plain, hidden, ...painted.values()]) {
        material.dispose();
      }
      disposeObject(object);
    },
  };
}

/** A dull material that the sun shades. */
function clay(colour?: string): MeshLambertMaterial {
  return new MeshLambertMaterial({
    flatShading: true,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    ...(colour !== undefined && { color: colour }),
  });
}

/** Which face was hit, from the extras that the export wrote, and its area. */
function describeHit(hit: Intersection): Selection | null {
  const mesh = hit.object;
  if (!(mesh instanceof Mesh)) {
    return null;
  }
  return {
    kind: "surface",
    surface: String(extra(mesh, "surface") ?? "face"),
    building: indexIn(mesh, "building"),
    facet: indexIn(mesh, "facet"),
    areaM2: areaOf(mesh.geometry),
  };
}

function matches(mesh: Mesh, selection: Selection | null): boolean {
  if (selection?.kind === "facet") {
    return indexIn(mesh, "facet") === selection.index;
  }
  return (
    selection?.kind === "surface" &&
    indexIn(mesh, "building") === selection.building &&
    indexIn(mesh, "facet") === selection.facet &&
    String(extra(mesh, "surface") ?? "face") === selection.surface &&
    Math.abs(areaOf(mesh.geometry) - selection.areaM2) < 1e-9
  );
}

/** An extra of the node or of the nearest one above it. */
function extra(object: Object3D, name: string): unknown {
  for (let at: Object3D | null = object; at !== null; at = at.parent) {
    if (name in at.userData) {
      return at.userData[name];
    }
  }
  return undefined;
}

/** The index of a mesh's building or facet, whose number the export wrote; null where it has none. */
function indexIn(mesh: Mesh, name: string): number | null {
  const number = extra(mesh, name);
  return typeof number === "number" ? indexOf(number) : null;
}

function areaOf(geometry: BufferGeometry): number {
  return trianglesOf(geometry).reduce((sum, corners) => sum + new Triangle(...corners).getArea(), 0);
}

/** Gives every corner of a face the tint of the face's own normal, as facets have it. */
function addTint({ geometry }: Mesh): void {
  const positions = geometry.getAttribute("position");
  const [corners] = trianglesOf(geometry);
  const normal = corners ? new Triangle(...corners).getNormal(new Vector3()) : new Vector3(0, 1, 0);
  // The GLB is Y up: back to Z up.
  const tint = normalTint({ plane: { normal: [normal.x, -normal.z, normal.y], d: 0 } }).toArray();
  const colours = Float32Array.from({ length: 3 * positions.count }, (_, i) => tint[i % 3] as number);
  geometry.setAttribute("color", new BufferAttribute(colours, 3));
}

/** Both ends of every edge of a face, in the model's frame. */
function edgePositions(mesh: Mesh): ArrayLike<number> & Iterable<number> {
  mesh.updateWorldMatrix(true, false);
  const geometry = new EdgesGeometry(mesh.geometry, EDGE_ANGLE_DEG).applyMatrix4(mesh.matrixWorld);
  return geometry.getAttribute("position").array;
}

export function edgeLines(positions: readonly number[]): LineSegments<BufferGeometry, LineBasicMaterial> {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(positions), 3));
  const edges = new LineSegments(geometry, new LineBasicMaterial());
  edges.visible = false;
  edges.raycast = () => undefined;
  return edges;
}

/** A large model has thousands of faces: between some of them the page may answer. */
async function inShortTasks<T>(items: readonly T[], work: (item: T) => void): Promise<void> {
  let start = performance.now();
  for (const item of items) {
    work(item);
    if (performance.now() - start > TASK_MS) {
      await new Promise((resolve) => setTimeout(resolve));
      start = performance.now();
    }
  }
}

function markerOf(meshes: readonly Mesh[]): Object3D {
  const marker = new Group();
  for (const mesh of meshes) {
    mesh.updateWorldMatrix(true, false);
    const tint = new Mesh(
      mesh.geometry.clone(),
      new MeshBasicMaterial({
        ...{ color: PALETTE.selected, transparent: true, opacity: 0.35 },
        ...{ polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 },
      }),
    );
    const outline = new LineSegments(
      new EdgesGeometry(mesh.geometry, EDGE_ANGLE_DEG),
      new LineBasicMaterial({ color: PALETTE.selected, depthTest: false }),
    );
    for (const part of [tint, outline]) {
      part.raycast = () => undefined;
      part.applyMatrix4(mesh.matrixWorld);
      marker.add(part);
    }
  }
  return marker;
}

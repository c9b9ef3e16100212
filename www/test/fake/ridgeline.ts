/**
 * A stand-in for the wasm package, with its interface and nothing behind it: one planted gable, seen from
 * straight above. For work on the page without Rust (`npm run dev:fake`) and for the worker's unit tests; it is never
 * part of a build.
 */

import type { GroundTexture, WarpedPicture } from "../../src/shared/calls";
import type { ParamTree } from "../../src/shared/paramTree";
import type {
  AdjacencyGraphs,
  ComparedModels,
  CoplanarSets,
  Correspondence,
  DensePlane,
  DensePlanes,
  Evidence,
  Facet,
  FacetTrace,
  FlightPlan,
  GroundPicture,
  GroupingTrace,
  HalfPlane,
  KnownComparison,
  LackingFile,
  LineRecord,
  MatchRecord,
  Params,
  Refinement,
  SceneInfo,
  SegmentMatching,
  SideRecord,
  SideTrace,
  StageSummary,
  Sunshine,
  TileReport,
  WorkPlan,
} from "../../src/shared/records";
import { stagesOf } from "../../src/stages/catalogue";
import type { CoreSession } from "../../src/worker/coreSession";
import { glbOf } from "./glb";

const SIZE_PX = 400;
const PX_PER_M = 20;

type P = [number, number, number];
/** A gable of 12 m by 8 m: eaves at 5 m, ridge at 8 m. */
const CORNERS: P[] = [
  [-6, -4, 5],
  [6, -4, 5],
  [6, 4, 5],
  [-6, 4, 5],
  [-6, 0, 8],
  [6, 0, 8],
];
const EDGES = [
  [0, 1],
  [2, 3],
  [4, 5],
  [0, 4],
  [3, 4],
  [1, 5],
  [2, 5],
] as const;
const SOUTH = { normal: [0, -0.6, 0.8] as P, d: -6.4 };
const NORTH = { normal: [0, 0.6, 0.8] as P, d: -6.4 };

const corner = (i: number) => CORNERS[i] as P;

function facet(indices: number[], plane: typeof SOUTH, probability: number, dense: number): Facet {
  return {
    outer: indices.map(corner),
    holes: [],
    plane,
    building: 0,
    similarity: 0.8,
    real_ratio: 1,
    probability,
    uncertainty: {
      height_m: 0.05,
      slope_deg: 0.4,
      corners: indices.map((i) => ({ at: corner(i), sigma_m: [0.03, 0.04, 0.06] })),
      sides: [],
    },
    lines: [],
    half_planes: [],
    proposals: [{ dense_plane: dense }],
    obstructions: [],
  };
}

export const FACETS: Facet[] = [facet([0, 1, 5, 4], SOUTH, 0.97, 0), facet([2, 3, 4, 5], NORTH, 0.72, 1)];

const HALF_PLANES: HalfPlane[] = [
  { line: 0, side: "left", theta: 0.64, plane: SOUTH },
  { line: 1, side: "left", theta: 0.64, plane: NORTH },
  { line: 2, side: "left", theta: -0.64, plane: NORTH },
  { line: 2, side: "right", theta: -0.64, plane: SOUTH },
].map((one) => ({
  ...one,
  side: one.side as "left" | "right",
  similarity: 0.7,
  sigma_theta: 0.01,
  curvature: 9,
  amplitude: 0.5,
  probability: 0.99,
  views: [0, 1, 2],
}));

/** Less and less from line to line speaks for them. */
function byViews(line: number): Evidence {
  return {
    prior: 3,
    terms: [
      { feature: "missing_views", value: line % 3, nats: 0.2 - 0.4 * (line % 3) },
      { feature: "correlation", value: 0.9 - 0.05 * line, nats: 0.4 - 0.3 * line },
      { feature: "ln_sigma_without_a_view_px", value: 0.3 * line, nats: 0.9 - 0.4 * line },
      { feature: "residual_rms_sigmas", value: 1.3, nats: -0.1 },
      { feature: "slope_deg", value: line < 3 ? 0 : 40, nats: line < 3 ? 0.5 : -1 },
    ],
  };
}

function inModel(before: number): Evidence {
  return {
    prior: 3.3,
    terms: [
      { feature: "nats_before", value: before, nats: 0.6 * (before - 3) },
      { feature: "is_border", value: 0, nats: 0.1 },
      { feature: "is_intersection", value: 0, nats: 0 },
      { feature: "share_on_surfaces", value: 1, nats: 0.5 },
      { feature: "hidden_views", value: 0, nats: 0 },
    ],
  };
}

function weighed(line: number) {
  const by_views = byViews(line);
  const in_model = inModel(natsOf(by_views));
  return { probability: 1 / (1 + Math.exp(-natsOf(in_model))), by_views, in_model };
}

const natsOf = ({ prior, terms }: Evidence) => terms.reduce((sum, { nats }) => sum + nats, prior);

export class Session implements CoreSession {
  #files: string[] = [];

  static defaultParams(): Params {
    const params: ParamTree = {
      segments: { min_length_px: 15 },
      matching: { window_px: 15 },
      adjustment: { enabled: true },
      lines3d: {},
      sweep: { max_theta_deg: 75, min_similarity: 0.4, min_curvature: 4, min_amplitude: 0.2 },
      sources: [] as unknown as ParamTree[string],
      roof: {},
      corrections: [] as unknown as ParamTree[string],
      texture: { max_atlas_px: 4096 },
    };
    return params as unknown as Params;
  }

  addFile(path: string): void {
    this.#files.push(path);
  }

  clearFiles(): void {
    this.#files = [];
  }

  inspect() {
    const images = this.#images().map((path) => ({
      path,
      name: path.slice(path.lastIndexOf("/") + 1),
      size: [SIZE_PX, SIZE_PX] as [number, number],
      orientation: "planted",
      stated: {
        camera: "",
        focal_mm: null,
        focal_px: null,
        taken: null,
        position: null,
        height_m: null,
        lacks_hemispheres: false,
        yaw_pitch_roll: null,
      },
    }));
    return {
      files: this.#files.map((path) => ({ path, kind: "image" as const, description: "a file" })),
      images,
      orientation: "planted",
      orientations: [{ label: "planted", path: "planted" }],
      views: images.length,
      peak_mb: 54,
      warnings: [],
      is_implausible: false,
      model: null,
      errors: images.length < 3 ? ["fewer than three views; add photographs"] : [],
    };
  }

  load(): SceneInfo {
    return this.scene();
  }

  scene(): SceneInfo {
    if (this.#images().length < 3) {
      throw Object.assign(new Error("fewer than three views; add photographs"), { name: "InputError" });
    }
    const views = this.#images().map((path, i) => ({
      name: path.slice(path.lastIndexOf("/") + 1),
      width: SIZE_PX,
      height: SIZE_PX,
      center: [0, 0, 4000 + i] as P,
      projection: downwards(4000 + i),
    }));
    return {
      views,
      origin: [1000, 2000, 0],
      warnings: [],
      agreement: null,
      known: { terrain: null, footprints: null, point_cloud: null },
    };
  }

  setParams(): void {}

  /** All views stay. */
  adjustOnce(onProgress: (fraction: number) => void): StageSummary | null {
    return this.runStage("adjustment", onProgress);
  }

  packCameras(): Uint8Array<ArrayBuffer> {
    return new Uint8Array();
  }

  takeCameras(): void {}

  runStage(stage: string, onProgress: (fraction: number) => void) {
    for (let step = 1; step <= 20; step += 1) {
      const until = performance.now() + 25;
      while (performance.now() < until);
      onProgress(step / 20);
    }
    return { stage, counts: { [stage]: 7 }, warnings: [] };
  }

  segments(): Float32Array {
    return Float32Array.from(EDGES.flatMap(([a, b]) => [...pixel(corner(a)), ...pixel(corner(b))]));
  }

  matchedSegments(): Float32Array {
    return Float32Array.from(
      EDGES.flatMap(([a, b], i) => [...pixel(corner(a)), ...pixel(corner(b)), i % 3, i]),
    );
  }

  lines(): Float64Array {
    return Float64Array.from(EDGES.flatMap(([a, b]) => [...corner(a), ...corner(b)]));
  }

  halfPlanes(): HalfPlane[] {
    return HALF_PLANES;
  }

  terrain(): KnownComparison | null {
    return null;
  }

  coplanar(): CoplanarSets {
    return { sets: [], trace: { sets: [] } };
  }

  adjacency(): AdjacencyGraphs {
    return { planes: [], trace: { graphs: [], corners: [] } };
  }

  dense(): DensePlanes {
    return denseGable();
  }

  facets(): Facet[] {
    return FACETS;
  }

  corrected() {
    return { outcomes: [], lines: [], sources: FACETS.map((_, i) => i) };
  }

  image() {
    const rgba = new Uint8ClampedArray(4 * SIZE_PX * SIZE_PX);
    for (let i = 0; i < SIZE_PX * SIZE_PX; i += 1) {
      const shade = 90 + 60 * Math.sin((i % SIZE_PX) / 23) * Math.cos(i / SIZE_PX / 31);
      rgba.set([shade, shade + 10, shade - 10, 255], 4 * i);
    }
    return { width: SIZE_PX, height: SIZE_PX, rgba };
  }

  shardMaps(stage: string): string[] {
    return stage === "segments" ? ["views"] : [];
  }

  shardsReadColours(): boolean {
    return false;
  }

  packView(): Uint8Array<ArrayBuffer> {
    return new Uint8Array([1]);
  }

  takeView(): void {}

  packPreliminary(): Uint8Array<ArrayBuffer> {
    return new Uint8Array([1]);
  }

  firstLook(): Facet[] {
    return this.facets();
  }

  handOver(): Uint8Array<ArrayBuffer> {
    return new Uint8Array();
  }

  takeOver(): void {}

  runShard(
    _stage: string,
    _map: string,
    index: number,
    of: number,
    onProgress: (fraction: number) => void,
  ): Uint8Array<ArrayBuffer> {
    onProgress(1);
    return new Uint8Array([index, of]);
  }

  mergeShards(): void {}

  chosenStages(): string[] {
    return stagesOf("lines");
  }

  rejectedSegments(): Float32Array {
    return Float32Array.from([20, 20, 60, 24, 1]);
  }

  matching(): MatchRecord {
    const none = { number: 0, length_px: 0 };
    return {
      z_range_m: [0, 10],
      view_pairs: [[0, 1]],
      candidates: 7,
      pairs: 7,
      triples_before: 7,
      triples_after: 7,
      detected: none,
      matched: none,
      merged: none,
      grown: none,
    };
  }

  segmentStory(view: number, segment: number): SegmentMatching {
    const other = view === 0 ? 1 : 0;
    const [a, b] = EDGES[segment] ?? EDGES[0];
    const ends = [pixel(corner(a)), pixel(corner(b))] as const;
    return {
      outcome: { kind: "matched", line: segment },
      beams: [{ view: other, corners: [ends[0], ends[0], ends[1], ends[1]] }],
      candidates: [{ view: other, segment, score: 0.9, line: segment, predictions: [] }],
    };
  }

  correspondence(
    _view: number,
    segment: number,
    _otherView: number,
    _other: number,
    t: number,
  ): Correspondence {
    const [a, b] = EDGES[segment] ?? EDGES[0];
    const [[x0, y0], [x1, y1]] = [pixel(corner(a)), pixel(corner(b))];
    const x = [x0 + t * (x1 - x0), y0 + t * (y1 - y0)] as const;
    const window = Array.from({ length: 225 }, (_, i) => (i % 15) / 15);
    return {
      x,
      epipolar: [0, 1, -x[1]],
      other: x,
      channel: "grey",
      window,
      other_window: window,
      correlation: 1 - t / 2,
    };
  }

  lineRecords(): LineRecord[] {
    return EDGES.map((_, i) => ({
      origin: "matched" as const,
      contradiction: null,
      ...weighed(i),
      sigma_m: 0.01 * (i + 1),
      covariance: [
        [1e-4, 0, 0, 1e-4, 0, 4e-4],
        [1e-4, 0, 0, 1e-4, 0, 1e-4],
      ],
      supports: [0, 1, 2].map((view) => ({ view, segments: [i], score: 0.8, kind: "matched" as const })),
    }));
  }

  detectedStretches(): Float64Array {
    return Float64Array.from(EDGES.flatMap(([a, b], i) => [i, ...corner(a), ...corner(b)]));
  }

  sides(): SideRecord[] {
    return EDGES.flatMap((_, line) =>
      (["left", "right"] as const).map((side) => ({
        line,
        side,
        rejection: HALF_PLANES.some((one) => one.line === line && one.side === side) ? null : "low_peak",
      })),
    );
  }

  side(line: number, left: boolean): SideTrace {
    const side = left ? "left" : "right";
    const thetas = Array.from({ length: 31 }, (_, i) => (i - 15) * 0.08);
    const own = HALF_PLANES.find((one) => one.line === line && one.side === side);
    const similarity = thetas.map((theta) => 0.7 / (1 + 20 * (theta - (own?.theta ?? 0)) ** 2));
    return {
      line,
      side,
      rejection: own === undefined ? "low_peak" : null,
      curve: {
        reference: 0,
        points: [],
        thetas,
        similarity,
        views: [{ view: 1, valid: true, similarity }],
        posterior: { density: similarity, plane: own === undefined ? 0.2 : 0.99 },
      },
    };
  }

  warped(_line: number, _left: boolean, theta: number): WarpedPicture {
    const [columns, rows] = [60, 24];
    const rgba = new Uint8ClampedArray(4 * columns * rows * 2).fill(160);
    const views = [0, 1].map((view) => ({
      view,
      similarity: view === 0 ? null : 0.7,
      valid: true,
      outline: null,
    }));
    return {
      about: { theta, reference: 0, similarity: 0.7, points: [], line_row: 4, columns, rows, views },
      rgba,
    };
  }

  ground(): GroundTexture {
    const corners: GroundPicture["corners"] = [
      [-20, 20, 0],
      [20, 20, 0],
      [20, -20, 0],
      [-20, -20, 0],
    ];
    return { about: { corners, width: 2, height: 2 }, rgba: new Uint8ClampedArray(16).fill(120) };
  }

  refinement(): Refinement {
    const facets = this.facets();
    const [a, b] = EDGES[0] as (typeof EDGES)[number];
    const [p0, p1] = [corner(a), corner(b)];
    return {
      gaps: [],
      before: { facets, sources: facets.map((_, i) => i) },
      buildings: [
        {
          building: 0,
          sides: EDGES.length,
          observations: 3 * EDGES.length,
          error_before_px: 0.8,
          error_after_px: 0.2,
          largest_move_m: 0.1,
          relations: [
            { kind: "horizontal", sides: [{ p0, p1 }], deviation_m: 0.01, chi2: 0.4, adopted: true },
          ],
          refused: null,
        },
      ],
    };
  }

  uncovered() {
    return [];
  }

  grouping(): GroupingTrace {
    const members = (lines: number[]) => lines.map((line) => ({ line, side: null, half_plane: null }));
    return {
      groups: [
        { plane: SOUTH, members: members([0, 2, 3, 5]), proposals: [{ dense_plane: 0 }] },
        { plane: NORTH, members: members([1, 2, 4, 6]), proposals: [{ dense_plane: 1 }] },
      ],
      plane_lines: [],
      borders: EDGES.map(([a, b]) => {
        const [p, q] = [corner(a), corner(b)];
        return { kind: "real" as const, a: [p[0], p[1]] as const, b: [q[0], q[1]] as const };
      }),
      cells: 2,
    };
  }

  verification(): FacetTrace {
    return { judged: [], rejected: [] };
  }

  regions(): null {
    return null;
  }

  directions(): null {
    return null;
  }

  clusters(): null {
    return null;
  }

  rectangles(): null {
    return null;
  }

  exportFile(name: string): Uint8Array<ArrayBuffer> {
    return name === "model.glb" ? glbOf(FACETS) : new TextEncoder().encode("{}");
  }

  reportWith(): void {}

  compareWith(): ComparedModels {
    return { buildings: [], facets: [] };
  }

  sunshine(): Sunshine[] | null {
    return null;
  }

  exportNames(): string[] {
    return ["model.glb", "report.json"];
  }

  planTiles(): void {}

  workPlan(): WorkPlan {
    const core: [number, number, number, number] = [0, 0, 50, 50];
    const views = this.#images().map((path) => ({ view: path, window: core, bytes: 0 }));
    const cells = [{ place: { core, region: core }, memory_mb: 10, views }];
    return { reduction: 1, order: [0], tiles: [{ tile: 1, core, memory_mb: 10, cells }] };
  }

  planFlight(): FlightPlan {
    const area: [number, number, number, number] = [0, 0, 50, 50];
    return {
      overview: {
        heights: [0, 0],
        ground: "stated",
        ground_z: 0,
        pixel_m: 0.05,
        reduction: 1,
        footprints: [],
        shown: area,
        overlap: { area, columns: 1, rows: 1, counts: [this.#images().length] },
      },
      tiles: [area],
      left_out: [],
      squares_left_out: 0,
      why_left_out: "fewer than three photographs show its ground",
      problem: null,
    };
  }

  groundFiles(): LackingFile[] {
    return [];
  }

  groundHeights(): [number, number] | null {
    return null;
  }

  groundFilesOfLoad(): LackingFile[] {
    return [];
  }

  viewFilesOfLoad(): LackingFile[] {
    return [];
  }

  squaresToLookAt(): number {
    return 1;
  }

  groundFilesOfLook(): LackingFile[] {
    return [];
  }

  viewFilesOfLook(): LackingFile[] {
    return [];
  }

  lookAt(_index: number, onProgress: (fraction: number) => void): Uint8Array<ArrayBuffer> {
    onProgress(1);
    return new Uint8Array([1]);
  }

  takeLook(): void {}

  groundFilesOfCell(): LackingFile[] {
    return [];
  }

  viewFilesOfCell(): LackingFile[] {
    return [];
  }

  lackingFiles(): LackingFile[] {
    return [];
  }

  addHead(): boolean {
    return false;
  }

  fillFile(): void {}

  fillRanges(): void {}

  emptyFiles(): void {}

  loadCell(): void {}

  runCell(_index: number, _cell: number, onProgress: (fraction: number) => void): void {
    onProgress(1);
  }

  tileOutcome(): Uint8Array<ArrayBuffer> {
    return new Uint8Array([1]);
  }

  tileModel(): { report: TileReport; glb: undefined } {
    return { report: { core: [0, 0, 50, 50], outcome: "1 building", is_left_out: false }, glb: undefined };
  }

  takeTile(): void {}

  joinTiles(): void {}

  exportProject(): Uint8Array<ArrayBuffer> {
    return new Uint8Array();
  }

  openedProject(): null {
    return null;
  }

  openedResults(): Uint8Array<ArrayBuffer> {
    return new Uint8Array();
  }

  #images(): string[] {
    return this.#files.filter((path) => path.endsWith(".jpg"));
  }
}

/** Patches a metre apart: on both roof sides, one of them uncertain, and north of them some in no plane. */
function denseGable(): DensePlanes {
  const rows = [-3.5, -2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 3.5, 5.5];
  const patches = rows.flatMap((y) =>
    Array.from({ length: 12 }, (_, i) => ({
      middle: [i - 5.5, y] as [number, number],
      z: y > 4 ? 1 : 8 - 0.75 * Math.abs(y) + 0.02 * ((i % 3) - 1),
      gradient: [0, y > 4 ? 0 : -0.75 * Math.sign(y)] as [number, number],
      correlation: 0.8,
      weight: 0.7,
    })),
  );
  const plane = (first: number, facetIndex: number, building: number): DensePlane => ({
    plane: facetIndex === 0 ? SOUTH : NORTH,
    covariance: [
      [1e-4, 0, 0],
      [0, 4e-6, 0],
      [0, 0, 4e-6],
    ],
    ring: FACETS[facetIndex]?.outer ?? [],
    patches: Array.from({ length: 48 }, (_, i) => first + i),
    area_m2: 48,
    rms_m: 0.02,
    class: { building, ground: (1 - building) / 4, vegetation: (3 * (1 - building)) / 4 },
  });
  const evidence = (nats: number): Evidence => ({
    prior: 0,
    terms: [{ feature: "height_m", value: 6, nats }],
  });
  return {
    planes: [plane(0, 0, 0.98), plane(48, 1, 0.6)],
    trace: {
      patches,
      classes: [4, 0.4].map((nats) => ({ building: evidence(nats), vegetation: evidence(1.1) })),
      spacing_m: 1,
    },
  };
}

/** A camera straight above the middle, so far away that every height has the same scale. */
function downwards(height: number): number[] {
  const focal = PX_PER_M * height;
  const half = SIZE_PX / 2;
  return [focal, 0, -half, half * height, 0, -focal, -half, half * height, 0, 0, -1, height];
}

function pixel([x, y]: P): [number, number] {
  return [SIZE_PX / 2 + x * PX_PER_M, SIZE_PX / 2 - y * PX_PER_M];
}

/** What the package's default export does: nothing to compile here. */
export default function init(): Promise<void> {
  return Promise.resolve();
}

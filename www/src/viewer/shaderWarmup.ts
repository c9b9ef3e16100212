/**
 * One thing of each layer, never shown: its shaders are made when the page opens. Otherwise each is made when a stage first
 * fills its layer, and asking for it waits for the graphics beside the running pipeline.
 */
import { Mesh, MeshBasicMaterial, type Object3D, Sphere, SphereGeometry, Texture, Vector3 } from "three";
import type { GroundTexture } from "../shared/calls";
import { PALETTE } from "../shared/palette";
import type { Facet, GroupingTrace, HalfPlane, LineRecord, SideRecord } from "../shared/records";
import { buildGroups } from "../stages/groups/groupsLayer";
import { buildFans } from "../stages/halfplanes/fansLayer";
import { buildLines } from "../stages/lines/linesLayer";
import { buildGround } from "../stages/model/groundLayer";
import { buildFacets } from "./layers/facets";
import { buildHighlight } from "./layers/highlight";
import { edgeLines } from "./layers/model";
import { buildOutlines } from "./layers/outlines";
import { buildGrid } from "./scene/grid";
import { disposeObject, type Layer, unpicked } from "./scene/layer";

const LINES = Float64Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0);
const GROUND: GroundTexture = {
  about: {
    corners: [
      [0, 1, 0],
      [1, 1, 0],
      [1, 0, 0],
      [0, 0, 0],
    ],
    width: 1,
    height: 1,
  },
  rgba: new Uint8ClampedArray(4),
};
const PLANE = { normal: [0, 0, 1], d: 0 } as const;
const NO_COVARIANCE: LineRecord["covariance"][number] = [0, 0, 0, 0, 0, 0];
const SEEN: LineRecord = {
  origin: "matched",
  contradiction: null,
  probability: 1,
  by_views: null,
  in_model: null,
  sigma_m: 0,
  covariance: [NO_COVARIANCE, NO_COVARIANCE],
  supports: [],
};
/** A line that no view shows has a shader of its own, for its dashes. */
const RECORDS: readonly LineRecord[] = [SEEN, { ...SEEN, origin: "intersection" }];
const HALF_PLANE: HalfPlane = {
  line: 0,
  side: "left",
  theta: 0,
  sigma_theta: 0,
  similarity: 1,
  curvature: 1,
  amplitude: 1,
  probability: 1,
  views: [],
  plane: PLANE,
};
const REJECTED: SideRecord = { line: 0, side: "right", rejection: "flat_curve" };
const FACET: Facet = {
  building: 0,
  plane: PLANE,
  outer: [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
  ],
  holes: [],
  similarity: 1,
  real_ratio: 1,
  probability: 1,
  uncertainty: null,
  lines: [],
  half_planes: [],
  proposals: [],
};
const GROUPING: GroupingTrace = {
  groups: [{ plane: PLANE, members: [{ line: 0, side: null, half_plane: null }], proposals: [] }],
  plane_lines: [{ segment: { p0: [0, 0, 0], p1: [1, 0, 0] }, views: [] }],
  borders: [],
  cells: 0,
};

export function warmupLayers(): Layer[] {
  return [
    buildLines(LINES, RECORDS, () => []),
    buildGround(GROUND),
    buildFans([HALF_PLANE], LINES, [REJECTED]),
    buildGroups(GROUPING, LINES, [FACET]),
    buildFacets([FACET]),
    buildOutlines([FACET]),
    buildHighlight([{ points: FACET.outer, closed: true }]),
    buildGrid(new Sphere(new Vector3(), 1), 0, PALETTE.unmatched),
    onlySeen(edgeLines([...LINES])),
    onlySeen(new Mesh(new SphereGeometry(), new MeshBasicMaterial({ map: new Texture() }))),
  ];
}

function onlySeen(object: Object3D): Layer {
  return unpicked({ object, dispose: () => disposeObject(object) });
}

/** The kinds of figures: what each is drawn with, the stages that it needs, and what is picked first. */
import type { ComponentType } from "preact";
import { ViewPicker } from "../app/images/ViewPicker";
import type { Tab } from "../app/state/methods";
import { ROWS, type Row, windowRows } from "../app/takeAlong/tables";
import { isVerifiedSet } from "../shared/proposed";
import type { Selection } from "../shared/selection";
import type { Method, StageName } from "../shared/stages";
import { AdjacencyLab } from "../stages/adjacency/AdjacencyLab";
import { ClusterLab } from "../stages/clusters/ClusterLab";
import { CoplanarLab } from "../stages/coplanar/CoplanarLab";
import { DenseLab } from "../stages/dense/DenseLab";
import { DirectionLab } from "../stages/directions/DirectionLab";
import { FacetLab } from "../stages/facets/FacetLab";
import type { Figure } from "../stages/figure";
import { SimLab } from "../stages/halfplanes/SimLab";
import { GroupLab, LineLab } from "../stages/lines/LineLab";
import { PointLab } from "../stages/matches/PointLab";
import { RectangleLab } from "../stages/rectangles/RectangleLab";
import { RefinementLab } from "../stages/refinement/RefinementLab";
import { ImageRow } from "./ImageRow";

export interface Kind {
  /** The page's own figure, whose text and paper it has. */
  tab: Tab;
  method: Method;
  /** The last stage that it needs. */
  stage: StageName;
  View: ComponentType<{ figure: Figure }>;
  /** What is picked until a reader picks. */
  begin: (figure: Figure) => Selection | null;
  /** The numbers behind it, where they are not those of its tab. */
  rows?: (figure: Figure) => Row[];
}

const NOTHING = () => null;

function lab(
  tab: Tab,
  method: Method,
  stage: StageName,
  View: Kind["View"],
  begin: Kind["begin"] = NOTHING,
): Kind {
  return { tab, method, stage, View, begin };
}

/** By the name that `kind` has in HTML. */
export const KINDS = {
  segments: lab("segments", "lines", "segments", withImages("segments")),
  "epipolar-beam": lab("matches", "lines", "matches", Beam, longSegment),
  "point-transfer": lab("matches", "lines", "matches", Transfer, longSegment),
  "correlation-windows": { ...lab("matches", "lines", "matches", PointLab, longSegment), rows: windowRows },
  "line-accuracy": lab("lines", "lines", "lines", LineLab, bestLine),
  "theta-sweep": lab("halfplanes", "lines", "halfplanes", SimLab, sharpestHalfPlane),
  groups: lab("groups", "lines", "groups", GroupLab, largestGroup),
  "facet-plan": lab("facets", "lines", "facets", FacetLab, firstFacet),
  refinement: lab("refinement", "lines", "refinement", RefinementLab, busiestBuilding),
  "dense-planes": lab("dense", "lines", "dense", DenseLab, largestBuilding),
  "coplanar-sets": lab("coplanar", "coplanar", "coplanar", CoplanarLab, clearestSet),
  adjacency: lab("adjacency", "adjacency", "adjacency", AdjacencyLab, richestCorner),
  regions: lab("regions", "rectangles", "regions", withImages("regions")),
  "main-directions": lab("directions", "rectangles", "directions", Directions),
  clusters: lab("clusters", "rectangles", "clusters", ClusterLab),
  rectangles: lab("rectangles", "rectangles", "rectangles", RectangleLab),
} as const satisfies Record<string, Kind>;

export type KindName = keyof typeof KINDS;

export const KIND_NAMES = Object.keys(KINDS) as readonly KindName[];

/** The numbers behind a figure, a record a row. */
export function rowsOf({ tab, rows = ROWS[tab] }: Kind, figure: Figure): Row[] {
  return rows(figure);
}

export function kindOf(name: string | null): Kind | null {
  return KIND_NAMES.includes(name as KindName) ? KINDS[name as KindName] : null;
}

/** B99 figures 1, 2 and 4: a segment, and its beam and candidates in the view of the one it is compared with. */
function Beam({ figure }: { figure: Figure }) {
  const [own, other] = viewsOfSegment(figure);
  return (
    <div class="over-lab">
      <ImageRow figure={figure} tab="matches" views={[own, other]} follows />
      <PointLab figure={figure} />
    </div>
  );
}

/** B99 figure 3: the pair predicts the line in a third view. */
function Transfer({ figure }: { figure: Figure }) {
  return (
    <div class="over-lab">
      <ImageRow figure={figure} tab="matches" views={viewsOfSegment(figure)} follows />
      <PointLab figure={figure} />
    </div>
  );
}

function Directions({ figure }: { figure: Figure }) {
  return (
    <div class="over-lab">
      <ImagesOf figure={figure} tab="directions" />
      <DirectionLab figure={figure} />
    </div>
  );
}

/** One view with what a stage found in it. */
function withImages(tab: Tab): Kind["View"] {
  return function Images({ figure }: { figure: Figure }) {
    return <ImagesOf figure={figure} tab={tab} />;
  };
}

function ImagesOf({ figure, tab }: { figure: Figure; tab: Tab }) {
  const { scene, view, act } = figure;
  return (
    <div class="picked-image">
      <ViewPicker views={scene?.views ?? []} shown={view} withAll={false} show={act.showView} />
      <ImageRow figure={figure} tab={tab} views={[Math.max(0, view)]} />
    </div>
  );
}

/** The segment's own view, that of the compared candidate, and that of its first prediction. */
function viewsOfSegment({ selection, detail: { story, candidate } }: Figure): [number, number, number] {
  const own = selection?.kind === "segment" ? selection.view : 0;
  const compared = story?.candidates[candidate];
  const other = compared?.view ?? (own === 0 ? 1 : 0);
  const predicted = compared?.predictions.find(({ verified }) => verified !== null);
  const third = [0, 1, 2].find((view) => view !== own && view !== other) ?? 0;
  return [own, other, predicted?.view ?? third];
}

/** Of the first view, pixels over its width: a longer segment is rather a kerb than the side of a roof. */
const LONGEST = 0.25;

/** The longest segment of the first view that is part of a match, of those that may be sides of roofs. */
function longSegment({ scene, results: { supports, segments } }: Figure): Selection | null {
  const longest = LONGEST * (scene?.views[0]?.width ?? Number.POSITIVE_INFINITY);
  const own = segments[0];
  const matched = supports[0];
  if (own === undefined || own.length < 4) {
    return null;
  }
  let best = { index: 0, length: 0 };
  for (let i = 0; 4 * i < own.length; i += 1) {
    const [x0, y0, x1, y1] = own.subarray(4 * i, 4 * i + 4) as unknown as [number, number, number, number];
    const length = Math.hypot(x1 - x0, y1 - y0);
    const isMatched = matched !== undefined && isAmong(matched, [x0, y0]);
    if (isMatched && length > best.length && length <= longest) {
      best = { index: i, length };
    }
  }
  return { kind: "segment", view: 0, index: best.index };
}

/** Whether a stretch that was matched begins or ends at a point. */
function isAmong(stretches: Float32Array, [x, y]: readonly [number, number]): boolean {
  for (let at = 0; at + 6 <= stretches.length; at += 6) {
    for (const end of [at, at + 2]) {
      if (Math.abs((stretches[end] as number) - x) + Math.abs((stretches[end + 1] as number) - y) < 2) {
        return true;
      }
    }
  }
  return false;
}

/** The matched line of most views; of several, the most accurate. */
function bestLine({ results: { records } }: Figure): Selection | null {
  const order = records
    .map(({ supports, sigma_m, origin }, index) => ({ index, views: supports.length, sigma_m, origin }))
    .filter(({ origin }) => origin === "matched")
    .sort((a, b) => b.views - a.views || a.sigma_m - b.sigma_m);
  return order[0] === undefined ? null : { kind: "line", index: order[0].index };
}

/** The place of the highest score that is more than nothing; -1 where there is none. */
function highest<T>(all: readonly T[] | undefined, score: (one: T) => number): number {
  const scores = all?.map(score) ?? [];
  const most = Math.max(0, ...scores);
  return most === 0 ? -1 : scores.indexOf(most);
}

function largestGroup({ results: { grouping } }: Figure): Selection | null {
  const index = highest(
    grouping?.groups,
    ({ members }) => members.filter(({ half_plane }) => half_plane !== null).length,
  );
  return index < 0 ? null : { kind: "group", index };
}

function firstFacet({ results: { facets } }: Figure): Selection | null {
  return facets === null || facets.length === 0 ? null : { kind: "facet", index: 0 };
}

/** The building with the most relations. */
function busiestBuilding({ results: { refinement } }: Figure): Selection | null {
  const index = highest(refinement?.buildings, ({ relations }) => relations.length);
  return index < 0 ? null : { kind: "refinement", index };
}

function largestBuilding({ results: { dense } }: Figure): Selection | null {
  const index = highest(dense?.planes, (plane) => plane.class.building * plane.patches.length);
  return index < 0 ? null : { kind: "dense", index };
}

/** Of the sets that the photographs verify, that of which they say most for its outline. */
function clearestSet({ results: { coplanar } }: Figure): Selection | null {
  const index = highest(coplanar?.sets, (set) => (isVerifiedSet(set) ? Math.max(0, set.outline_nats) : 0));
  return index < 0 ? null : { kind: "coplanar", index };
}

/** The corner with the most edges in the most views. */
function richestCorner({ results: { adjacency } }: Figure): Selection | null {
  const index = highest(adjacency?.trace.corners, ({ edges, images }) => edges.length * images.length);
  return index < 0 ? null : { kind: "corner", index };
}

/** The half-plane with the highest and sharpest peak. */
function sharpestHalfPlane({ results: { halfPlanes } }: Figure): Selection | null {
  const index = highest(halfPlanes ?? [], ({ probability, amplitude, similarity, theta }) => {
    // A slope shows more than a level roof, on which all angles begin.
    return probability * amplitude * similarity * (Math.abs(theta) > 0.2 ? 2 : 1);
  });
  return index < 0 ? null : { kind: "halfplane", index };
}

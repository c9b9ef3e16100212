/** In the figures of W96, and in plan: main directions, regions, faces. */
import { boundsOf, DEGREE, isInside } from "../../shared/linear";
import type { Vec2 } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import type { Figure } from "../../stages/figure";
import { inUnit, kindOf, readQuantity } from "../judging/quantity";
import { figureExercise, mistakeAmong, type Outcome } from "./judgeFigure";
import { EDGES, FACES, faceOver, imageIn, type Place, type RoofEdge, type RoofFace } from "./truth";

const TOLERANCE_DEG = 2;

const azimuthOf = ([ax, ay]: Vec2 | readonly number[], [bx, by]: Vec2 | readonly number[]) =>
  (((Math.atan2((by ?? 0) - (ay ?? 0), (bx ?? 0) - (ax ?? 0)) / DEGREE) % 180) + 180) % 180;

/** Between directions of lines, degrees: 0 to 90. */
const turned = (a: number, b: number) => Math.abs(((((a - b) % 180) + 270) % 180) - 90);

/** The azimuth of the longest ridge in a window, degrees; null where there is none. */
export function ridgeIn(shown: Figure, plane: number): number | null {
  const window = shown.results.directions?.windows[plane];
  if (window === undefined) {
    return null;
  }
  const { min, max } = window;
  const isIn = ([x = 0, y = 0]: readonly number[]) => x > min[0] && x < max[0] && y > min[1] && y < max[1];
  const ridges = EDGES.filter(({ kind, p0, p1 }) => kind === "ridge" && isIn(p0) && isIn(p1));
  const length = ({ p0, p1 }: RoofEdge) => Math.hypot(p1[0] - p0[0], p1[1] - p0[1]);
  const [longest] = ridges.sort((a, b) => length(b) - length(a));
  return longest === undefined ? null : azimuthOf(longest.p0, longest.p1);
}

/** The windows that have a ridge whose direction can be told from its mistakes. */
function clearWindows(shown: Figure): number[] {
  const count = shown.results.directions?.windows.length ?? 0;
  return Array.from({ length: count }, (_, i) => i).filter((i) => {
    const azimuth = ridgeIn(shown, i);
    return (
      azimuth !== null &&
      turned(azimuth, 45) > 3 * TOLERANCE_DEG &&
      turned(azimuth, 90 - azimuth) > 3 * TOLERANCE_DEG
    );
  });
}

export const ridgeDirection = figureExercise({
  name: "ridgeDirection",
  title: "The direction of a ridge",
  lesson: "object-space",
  source: "W96 3.4, figures 4 and 5",
  text: "The histogram of azimuths of this building has two peaks, at right angles. In which direction does its longest [[ridge]] run? Read it off, within 2°; the photograph tells which of the two [[main-direction|main directions]] it is. (Azimuths count from X, to the east, towards Y, to the north.)",
  figure: "main-directions",
  asks: { by: "number", unit: "deg" },
  begin: async ({ shown }) => ({ plane: clearWindows(shown)[0] ?? 0, view: 0 }),
  judge: async ({ shown }, given): Promise<Outcome> => {
    const truth = ridgeIn(shown, shown.plane);
    if (truth === null) {
      return { form: "This building has no ridge. Show another one." };
    }
    const read = readQuantity(given);
    if ("problem" in read) {
      return { form: read.problem };
    }
    if (kindOf(read.quantity.unit) !== "angle") {
      return { form: "An azimuth is an angle: degrees." };
    }
    const isNear = (angle: number) => turned(inUnit(read.quantity, "deg"), angle) <= TOLERANCE_DEG;
    if (isNear(truth)) {
      return "right";
    }
    return (
      mistakeAmong({
        "the perpendicular direction": isNear(truth + 90),
        "from north": isNear(90 - truth),
        "wrong sense": isNear(-truth),
      }) ?? { wrong: "There is no peak of the histogram there." }
    );
  },
  answer: async ({ shown }) => {
    const truth = ridgeIn(shown, shown.plane) ?? 0;
    return { words: `${truth.toFixed(1)}°`, given: `${truth.toFixed(1)} deg` };
  },
  solution:
    "Both peaks are directions of eaves and ridges. In the photograph the ridge runs along the longer side of the roof.",
  mistakes: {
    "the perpendicular direction":
      "This is the other main direction: that of the gables, or of the shorter eaves.",
    "from north": "This counts from north, clockwise. In the histogram azimuths count from X towards Y.",
    "wrong sense":
      "This counts the wrong way round: azimuths grow from X towards Y, counter-clockwise in plan.",
  },
});

/** Places on a grid over some rings. */
function sampled(rings: readonly (readonly (readonly number[])[])[], step: number): Place[] {
  const [x0, y0, x1, y1] = boundsOf(rings.flat());
  const places: Place[] = [];
  for (let y = y0 + step / 2; y < y1; y += step) {
    for (let x = x0 + step / 2; x < x1; x += step) {
      if (rings.filter((ring) => isInside([x, y], ring)).length % 2 === 1) {
        places.push([x, y]);
      }
    }
  }
  return places;
}

interface Covered {
  face: RoofFace;
  /** Of the region that the face covers, and of the face that the region covers. */
  ofRegion: number;
  ofFace: number;
}

/** The faces that a region of a view covers a part of, the largest part first. */
export function facesUnder(shown: Figure, view: number, index: number): Covered[] {
  const info = shown.scene?.views[view];
  const region = shown.results.regions[view]?.regions[index];
  if (info === undefined || region === undefined) {
    return [];
  }
  const box = boundsOf(region.rings.flat());
  const near = FACES.map((face) => ({
    face,
    ring: face.polygon.map((point) => imageIn(info, point)),
  })).filter(({ ring }) => doMeet(box, boundsOf(ring)));
  const own = near.length === 0 ? [] : sampled(region.rings, 2);
  return near
    .map(({ face, ring }) => {
      const common = own.filter((place) => isInside(place, ring)).length;
      const area = common === 0 ? 1 : Math.max(1, sampled([ring], 2).length);
      return { face, ofRegion: common / Math.max(1, own.length), ofFace: common / area };
    })
    .filter(({ ofRegion }) => ofRegion > 0)
    .sort((a, b) => b.ofRegion - a.ofRegion);
}

type Box = ReturnType<typeof boundsOf>;

const doMeet = (a: Box, b: Box) => a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];

/** What is to be said of a region. */
export function outcomeOfRegion(covered: readonly Covered[]): Outcome {
  const [most] = covered;
  const { ofRegion = 0, ofFace = 0 } = most ?? {};
  return (
    mistakeAmong({
      "no roof": covered.reduce((sum, one) => sum + one.ofRegion, 0) < 0.4,
      "several faces": covered.filter((one) => one.ofFace > 0.5).length > 1,
      "beyond the face": ofRegion < 0.75,
      "a part of a face": ofFace < 0.75,
    }) ?? "right"
  );
}

export const wholeFace = figureExercise({
  name: "wholeFace",
  title: "A region that is a roof face",
  lesson: "object-space",
  source: "W96 3.3, figure 3",
  text: "Pick a [[region]] that is a face of a roof: at least three quarters of the face, and at most a quarter beyond it.",
  figure: "regions",
  begin: async () => ({ view: 0 }),
  judge: async ({ shown }): Promise<Outcome> => {
    const { selection } = shown;
    return selection?.kind === "region"
      ? outcomeOfRegion(facesUnder(shown, selection.view, selection.index))
      : { form: "Pick a region in the photograph." };
  },
  answer: async ({ shown }) => {
    const count = shown.results.regions[0]?.regions.length ?? 0;
    const right = Array.from({ length: count }, (_, i) => i).filter(
      (i) => outcomeOfRegion(facesUnder(shown, 0, i)) === "right",
    );
    const [first] = right;
    return {
      words: `Regions ${right.map(numberOf).join(", ")} of ${shown.scene?.views[0]?.name ?? ""}, and such of the other views.`,
      ...(first === undefined ? {} : { state: { select: `region:0.${first}`, view: 0 } }),
    };
  },
  solution:
    "Where a face is lit evenly and its neighbours are not, the shortest description has one region for it, with straight boundaries along its edges.",
  mistakes: {
    "no roof": "This region is not on a roof: a garden, a street, a shadow.",
    "several faces":
      "This region covers several faces, which look alike in this light: the description was shorter without the boundary between them.",
    "a part of a face": "This is a part of a face: something on the roof, or its texture, cut it in pieces.",
    "beyond the face": "This region goes on beyond the face, where the ground has the same grey level.",
  },
});

/** The kinds of edges around a face. */
const edgesAround = ({ id }: RoofFace) =>
  EDGES.filter(({ faces }) => faces.includes(id)).map(({ kind }) => kind);

/** The face that a facet in plan is of. */
function faceOfFacet(outer: readonly (readonly number[])[]): RoofFace | null {
  const places = sampled([outer], 0.5);
  const faces = places.flatMap((place) => faceOver(place) ?? []);
  const count = (face: RoofFace) => faces.filter((one) => one === face).length;
  const [most] = [...new Set(faces)].sort((a, b) => count(b) - count(a));
  return most !== undefined && count(most) > 0.5 * places.length ? most : null;
}

/** Is a face a hip end: with two hips and no part of the ridge? */
function isHipEnd(face: RoofFace | null): boolean {
  const around = face === null ? [] : edgesAround(face);
  return around.filter((kind) => kind === "hip").length >= 2 && !around.includes("ridge");
}

export const hipEnd = figureExercise({
  name: "hipEnd",
  title: "A hip end in plan",
  lesson: "roofs",
  source: "B99 4.3, figures 21 to 23",
  text: "Pick a [[facet]] that is a hip end: bounded by an [[eave]] and two [[hip|hips]], with no part of the [[ridge]].",
  figure: "facet-plan",
  begin: async ({ shown }) => {
    const other = (shown.results.facets ?? []).findIndex(({ outer }) => !isHipEnd(faceOfFacet(outer)));
    return other < 0 ? {} : { select: `facet:${other}` };
  },
  judge: async ({ shown }): Promise<Outcome> => {
    const { selection, results } = shown;
    if (selection?.kind !== "facet") {
      return { form: "Pick a facet in the plan." };
    }
    const facet = results.facets?.[selection.index];
    const face = facet === undefined ? null : faceOfFacet(facet.outer);
    if (face === null) {
      return { mistake: "no face of a roof" };
    }
    const around = edgesAround(face);
    const hips = around.filter((kind) => kind === "hip").length;
    if (around.includes("ridge")) {
      return { mistake: hips > 0 ? "beside the hip end" : "a gable" };
    }
    return hips >= 2 ? "right" : { wrong: "This face has fewer than two hips." };
  },
  answer: async ({ shown }) => {
    const facets = shown.results.facets ?? [];
    const right = facets.flatMap(({ outer }, i) => (isHipEnd(faceOfFacet(outer)) ? [i] : []));
    return {
      words: `Facets ${right.map(numberOf).join(", ")}.`,
      ...(right[0] === undefined ? {} : { state: { select: `facet:${right[0]}` } }),
    };
  },
  solution:
    "In plan a hip end is a triangle, or a triangle without its corners, at the short side of a roof.",
  mistakes: {
    "beside the hip end":
      "This face reaches up to the ridge, between the hips: it is the long side of a hip roof.",
    "a gable": "This face reaches from the eave to the ridge and ends at gables: there is no hip.",
    "no face of a roof": "The scene has no face of a roof there: the facet is wrong.",
  },
});

/** What the inspector says of the picked thing: its numbers, what made it and what it made. */

import { LINE_STRIDE, SEGMENT_STRIDE } from "../../shared/flatArrays";
import {
  coplanarSetsOf,
  cornerPlanesOf,
  densePlanesOf,
  type Facet,
  isMadeFrom,
  type PlaneGroup,
  rectanglesOf,
  type Vec3,
} from "../../shared/records";
import type { Selection } from "../../shared/selection";
import { slopedArea } from "../parts/facetArea";
import { degreesOf, grouped, slopeOf } from "../parts/numberText";
import {
  CONTRADICTION_WORDS,
  ORIGIN_WORDS,
  outcomeWords,
  PAIR_WORDS,
  REJECTION_WORDS,
} from "../parts/reasonText";
import { lineOfSegment } from "../selection/selectionShapes";
import { params } from "../state/parameters";
import { results } from "../state/results";
import { scene } from "../state/scene";
import { selectionDetail } from "../state/selectionDetail";
import { coplanarSetRows } from "./coplanarSetRows";
import { cornerRows } from "./cornerRows";
import { densePlaneRows } from "./densePlaneRows";
import { evidenceOfLine, probabilityRow } from "./evidenceRows";
import { footprintRows } from "./footprintRows";
import { refinedRow, refinementRows, relationRows } from "./refinementRows";
import { rejectedClusterRows, rejectedFacetRows, rejectedSegmentRows } from "./rejectedRows";
import {
  indicesOf,
  linkToCoplanar,
  linkToCorner,
  linkToDense,
  linkToFacet,
  linkToGroup,
  linkToHalfPlane,
  linkToLine,
  type Related,
  type Row,
} from "./rowLinks";

export function titleOf(picked: Selection): string {
  switch (picked.kind) {
    case "segment":
      return `Segment ${picked.index} of ${viewName(picked.view)}`;
    case "rejectedSegment":
      return `Rejected line ${picked.index} of ${viewName(picked.view)}`;
    case "line":
      return `3D line ${picked.index}`;
    case "side":
      return `3D line ${picked.line}, ${picked.side} side`;
    case "dense":
      return `Dense plane ${picked.index}`;
    case "coplanar":
      return `Coplanar set ${picked.index}`;
    case "corner":
      return `Corner ${picked.index}`;
    case "group":
      return `Group ${picked.index}`;
    case "region":
      return `Region ${picked.index} of ${viewName(picked.view)}`;
    case "pair":
      return `Pair of lines ${results.value.rectangles?.pairs[picked.index]?.lines.join(" and ") ?? ""}`;
    case "halfplane":
      return `Half-plane ${picked.index}`;
    case "facet":
      return `Facet ${picked.index}`;
    case "rejectedFacet":
      return `Rejected facet ${picked.index}`;
    case "footprint":
      return `Footprint ${results.value.verification?.register?.footprints[picked.index]?.name ?? picked.index}`;
    case "cluster":
      return `Rejected cluster ${picked.index} of plane ${picked.plane}`;
    case "refinement":
      return `Building ${picked.index}, refined`;
    case "relation":
      return `Relation ${picked.index} of building ${picked.building}`;
    case "surface":
      return picked.surface.charAt(0).toUpperCase() + picked.surface.slice(1);
    case "view":
      return `View ${viewName(picked.index)}`;
  }
}

export function rowsOf(picked: Selection): Row[] {
  switch (picked.kind) {
    case "segment":
      return segmentRows(picked.view, picked.index);
    case "rejectedSegment":
      return rejectedSegmentRows(picked.view, picked.index);
    case "line":
      return lineRows(picked.index);
    case "side":
      return sideRows(picked.line, picked.side);
    case "dense":
      return densePlaneRows(picked.index);
    case "coplanar":
      return coplanarSetRows(picked.index);
    case "corner":
      return cornerRows(picked.index);
    case "group":
      return groupRows(picked.index);
    case "region":
      return regionRows(picked.view, picked.index);
    case "pair":
      return pairRows(picked.index);
    case "halfplane":
      return halfPlaneRows(picked.index);
    case "facet":
      return facetRows(picked.index);
    case "rejectedFacet":
      return rejectedFacetRows(picked.index);
    case "footprint":
      return footprintRows(picked.index);
    case "cluster":
      return rejectedClusterRows(picked.plane, picked.index);
    case "refinement":
      return refinementRows(picked.index);
    case "relation":
      return relationRows(picked.building, picked.index);
    case "surface":
      return surfaceRows(picked);
    case "view":
      return viewRows(picked.index);
  }
}

function segmentRows(view: number, index: number): Row[] {
  const data = results.value.segments[view];
  const at = index * SEGMENT_STRIDE;
  if (data === undefined || at + SEGMENT_STRIDE > data.length) {
    return [];
  }
  const [x0, y0, x1, y1] = [...data.subarray(at, at + SEGMENT_STRIDE)] as [number, number, number, number];
  return [
    ["Length", `${Math.hypot(x1 - x0, y1 - y0).toFixed(1)} px`],
    ["Start", `${x0.toFixed(2)}, ${y0.toFixed(2)} px`],
    ["End", `${x1.toFixed(2)}, ${y1.toFixed(2)} px`],
    ["Direction", `${degrees(Math.atan2(y1 - y0, x1 - x0))} (y down)`],
    ...historyOfSegment(view, index),
  ];
}

function historyOfSegment(view: number, index: number): Row[] {
  const { story } = selectionDetail.value;
  const lines = lineOfSegment(view, index, results.value).map(linkToLine);
  return [
    ...(story === null
      ? []
      : [
          ["Outcome", outcomeWords(story.outcome)] as const,
          ["Candidates", String(story.candidates.length)] as const,
        ]),
    ...(results.value.lines === null ? [] : [["3D line", lines] as const]),
  ];
}

function sideRows(line: number, side: string): Row[] {
  const record = results.value.sides.find((one) => one.line === line && one.side === side);
  const own = indicesOf(results.value.halfPlanes, (one) => one.line === line && one.side === side);
  return [
    ["3D line", [linkToLine(line)]],
    ["Half-plane", own.map(linkToHalfPlane)],
    ...(record?.rejection == null
      ? []
      : [["Rejected", REJECTION_WORDS[record.rejection] ?? record.rejection] as const]),
  ];
}

function groupRows(index: number): Row[] {
  const group = results.value.grouping?.groups[index];
  if (group === undefined) {
    return [];
  }
  const lines = [...new Set(group.members.map(({ line }) => line))];
  const halfPlanes = group.members.flatMap(({ half_plane }) => (half_plane === null ? [] : [half_plane]));
  const facets = indicesOf(results.value.facets, (facet) => isMadeFrom(facet, group));
  return [
    ["Slope of the plane", slopeText(group.plane.normal)],
    ["3D lines", lines.map(linkToLine)],
    ["Half-planes", halfPlanes.map(linkToHalfPlane)],
    ...proposalRows(group),
    ["Facets", facets.map(linkToFacet)],
  ];
}

/** The planes of dense matching, the coplanar sets and the corners that proposed this one, and how many candidates of the other method. */
function proposalRows(proposed: Pick<PlaneGroup, "proposals">): Row[] {
  const [dense, rectangles] = [densePlanesOf(proposed), rectanglesOf(proposed).length];
  const sets = coplanarSetsOf(proposed);
  const regions = cornerPlanesOf(proposed).flatMap(
    (plane) => results.value.adjacency?.planes[plane]?.regions ?? [],
  );
  const corners = [...new Set(regions.map(([corner]) => corner))];
  return [
    ...(dense.length === 0 ? [] : [["Dense planes", dense.map(linkToDense)] as const]),
    ...(sets.length === 0 ? [] : [["Coplanar sets", sets.map(linkToCoplanar)] as const]),
    ...(corners.length === 0 ? [] : [["Proposed by corners", corners.map(linkToCorner)] as const]),
    ...(rectangles === 0 ? [] : [["Rectangles", `${rectangles} in its plane (W96 3.6)`] as const]),
  ];
}

function regionRows(view: number, index: number): Row[] {
  const found = results.value.regions[view];
  const region = found?.regions[index];
  return region === undefined
    ? []
    : [
        ["Area", `${grouped(region.area_px)} px`],
        ["Perimeter", `${region.perimeter_px.toFixed(0)} px`],
        ["Mean grey value", region.mean.toFixed(1)],
        ["Standard deviation", Math.sqrt(region.variance).toFixed(1)],
        ["Regions at the start", grouped(found?.initial_regions ?? 0)],
        ...Object.entries(found?.moves ?? {}).map(
          ([move, count]) => [MOVES[move] ?? move, grouped(count)] as const,
        ),
      ];
}

const MOVES: Record<string, string> = { dropped: "Break points dropped", merged: "Regions merged" };

function pairRows(index: number): Row[] {
  const found = results.value.rectangles;
  const pair = found?.pairs[index];
  if (found == null || pair === undefined) {
    return [];
  }
  const candidate = found.candidates.find(
    ({ lines }) => lines.length === 2 && lines.every((line) => pair.lines.includes(line)),
  );
  const facets = indicesOf(
    results.value.facets,
    (facet) => facet.lines?.length === 2 && facet.lines.every((line) => pair.lines.includes(line)),
  );
  return [
    ["3D lines", pair.lines.map(linkToLine)],
    ["Lines that cross", String(pair.crossings.length)],
    ["Ends found", String(pair.ends.length)],
    ...(pair.rejection === null ? [] : [["Rejected", PAIR_WORDS[pair.rejection] ?? pair.rejection] as const]),
    ...(candidate === undefined
      ? []
      : [
          ["Outline covered", `${Math.round(100 * candidate.features.outline_on_lines)} %`] as const,
          ["Correlation inside", candidate.correlation.toFixed(2)] as const,
          ["Views for the plane", `${candidate.features.plane_nats_per_m2.toFixed(1)} nats/m²`] as const,
          [
            "... more than beside it",
            `${candidate.features.displaced_plane_margin_nats_per_m2.toFixed(1)} nats/m²`,
          ] as const,
        ]),
    ["Facets", facets.map(linkToFacet)],
  ];
}

function lineRows(index: number): Row[] {
  const { lines } = results.value;
  const rows: Row[] = [];
  const at = index * LINE_STRIDE;
  if (lines !== null && at + LINE_STRIDE <= lines.length) {
    const p0 = [...lines.subarray(at, at + 3)] as unknown as Vec3;
    const p1 = [...lines.subarray(at + 3, at + 6)] as unknown as Vec3;
    const [dx, dy, dz] = [p1[0] - p0[0], p1[1] - p0[1], p1[2] - p0[2]];
    const plan = Math.hypot(dx, dy);
    rows.push(
      ["Length", `${Math.hypot(plan, dz).toFixed(2)} m`],
      ["Slope", degrees(Math.atan2(dz, plan))],
      ["Azimuth", azimuth(dx, dy)],
      ["Start", worldText(p0)],
      ["End", worldText(p1)],
      ...historyOfLine(index),
    );
  }
  return rows;
}

/** What made a line, view by view, and what it is part of. */
function historyOfLine(index: number): Row[] {
  const { records, halfPlanes, sides, grouping, facets } = results.value;
  const record = records[index];
  // In object space nothing is matched: the score is the share of the line that boundaries cover.
  const isClustered = results.value.clusters !== null;
  const rejected = sides.filter(({ line, rejection }) => line === index && rejection !== null);
  return [
    ...(record === undefined
      ? []
      : [["Found", ORIGIN_WORDS[isClustered ? "clustered" : record.origin]] as const]),
    ...(record?.contradiction == null
      ? []
      : [["Contradicted", CONTRADICTION_WORDS[record.contradiction]] as const]),
    ...(record === undefined ? [] : evidenceOfLine(record)),
    ...(record === undefined ? [] : [["σ across", `${(100 * record.sigma_m).toFixed(1)} cm`] as const]),
    ...(record?.supports ?? []).map(
      ({ view, segments, kind, score }) =>
        [
          viewName(view),
          segments.map(
            (segment): Related => ({
              name: String(segment),
              selection: { kind: "segment", view, index: segment },
            }),
          ),
          isClustered ? `show ${Math.round(100 * score)} % of it` : `${kind} ${score.toFixed(2)}`,
        ] as const,
    ),
    ...(halfPlanes === null
      ? []
      : [["Half-planes", indicesOf(halfPlanes, ({ line }) => line === index).map(linkToHalfPlane)] as const]),
    ...rejected.map(
      ({ side, rejection }) =>
        [`Rejected, ${side}`, REJECTION_WORDS[rejection ?? ""] ?? rejection ?? ""] as const,
    ),
    ...(grouping === null
      ? []
      : [
          [
            "Groups",
            indicesOf(grouping.groups, ({ members }) => members.some(({ line }) => line === index)).map(
              linkToGroup,
            ),
          ] as const,
        ]),
    ...(facets === null
      ? []
      : [
          [
            "Facets",
            indicesOf(facets, ({ lines }) => lines?.includes(index) === true).map(linkToFacet),
          ] as const,
        ]),
  ];
}

function halfPlaneRows(index: number): Row[] {
  const plane = results.value.halfPlanes?.[index];
  if (plane === undefined) {
    return [];
  }
  const sigma = plane.sigma_theta === undefined ? "" : ` ± ${degrees(plane.sigma_theta)}`;
  return [
    ["3D line", [linkToLine(plane.line)]],
    ["Side", plane.side],
    ["θ", `${degrees(plane.theta)}${sigma}`],
    ["Sim(θ)", `${plane.similarity.toFixed(3)}${threshold("min_similarity")}`],
    ["Curvature |Sim″|", `${plane.curvature.toFixed(1)}${threshold("min_curvature")}`],
    ["Amplitude", `${plane.amplitude.toFixed(3)}${threshold("min_amplitude")}`],
    ["P(plane at θ)", `${plane.probability.toFixed(3)}${threshold("min_probability")}`],
    ["Slope of the plane", slopeText(plane.plane.normal)],
    ["Views", plane.views.map(viewName).join(", ")],
    ...(results.value.grouping === null
      ? []
      : [
          [
            "Group",
            indicesOf(results.value.grouping.groups, ({ members }) =>
              members.some(({ half_plane }) => half_plane === index),
            ).map(linkToGroup),
          ] as const,
        ]),
    ...(results.value.facets === null
      ? []
      : [
          [
            "Facets",
            indicesOf(results.value.facets, ({ half_planes }) => half_planes?.includes(index) === true).map(
              linkToFacet,
            ),
          ] as const,
        ]),
  ];
}

function facetRows(index: number): Row[] {
  const facet = results.value.facets?.[index];
  if (facet === undefined) {
    return [];
  }
  const [nx, ny] = facet.plane.normal;
  return [
    ["Building", String(facet.building)],
    ["Area", `${slopedArea(facet).toFixed(1)} m²`],
    ["Slope", `${slopeText(facet.plane.normal)}${plusMinus(facet.uncertainty?.slope_deg, 2, "°")}`],
    ["Faces", Math.hypot(nx, ny) < 0.02 ? "level" : azimuth(nx, ny)],
    ["Corners", `${facet.outer.length + facet.holes.flat().length}${cornerSigma(facet)}`],
    ...heightSigma(facet),
    ["Similarity", facet.similarity.toFixed(3)],
    ["τ real", facet.real_ratio === undefined ? "–" : facet.real_ratio.toFixed(2)],
    ...probabilityRow(facet.probability),
    ["3D lines", (facet.lines ?? []).map(linkToLine)],
    ...groupsOfFacet(facet),
    ...refinedRow(index),
    ...(results.value.grouping === null ? [] : proposalRows(facet)),
    ...((facet.half_planes ?? []).length === 0
      ? []
      : [["Half-planes", (facet.half_planes ?? []).map(linkToHalfPlane)] as const]),
  ];
}

/** A standard deviation behind a value; nothing where it is not known. */
function plusMinus(sigma: number | undefined, digits: number, unit: string): string {
  return sigma === undefined ? "" : ` ± ${sigma.toFixed(digits)}${unit}`;
}

/** The median over the corners of their standard deviation in plan. */
function cornerSigma({ uncertainty }: Facet): string {
  const inPlan = (uncertainty?.corners ?? []).map(({ sigma_m: [x, y] }) => Math.hypot(x, y) / Math.SQRT2);
  inPlan.sort((a, b) => a - b);
  return plusMinus(inPlan[Math.floor(inPlan.length / 2)], 2, " m");
}

function heightSigma({ uncertainty }: Facet): Row[] {
  return uncertainty ? [["Height in its middle", `± ${uncertainty.height_m.toFixed(2)} m`]] : [];
}

/** The groups of the half-planes, or of other proposals, that a facet was made from. */
function groupsOfFacet(facet: Facet): Row[] {
  const groups = indicesOf(results.value.grouping?.groups, (group) => isMadeFrom(facet, group));
  return groups.length === 0 ? [] : [["Groups", groups.map(linkToGroup)]];
}

function surfaceRows(picked: Extract<Selection, { kind: "surface" }>): Row[] {
  const rows: Row[] = [["Area", `${picked.areaM2.toFixed(1)} m²`]];
  if (picked.building !== null) {
    rows.push(["Building", String(picked.building)]);
  }
  if (picked.facet !== null) {
    rows.push(
      ["Facet", String(picked.facet)],
      ...facetRows(picked.facet).filter(([label]) => !SHOWN.has(label)),
    );
  }
  return rows;
}

/** Rows of a facet that a surface shows by itself. */
const SHOWN = new Set(["Building", "Area"]);

function viewRows(index: number): Row[] {
  const view = scene.value?.views[index];
  return view === undefined
    ? []
    : [
        ["Size", `${view.width} × ${view.height} px`],
        ["Centre", worldText(view.center)],
      ];
}

function viewName(view: number): string {
  return scene.value?.views[view]?.name ?? `view ${view}`;
}

/** The acceptance threshold of the sweep, as the present parameters have it. */
function threshold(name: string): string {
  const value = params.value["sweep"]?.[name];
  return typeof value === "number" ? ` (≥ ${value})` : "";
}

/** A point of the local frame in the frame of the input. */
function worldText([x, y, z]: Vec3): string {
  const [ox, oy, oz] = scene.value?.origin ?? [0, 0, 0];
  return `${(x + ox).toFixed(2)}, ${(y + oy).toFixed(2)}, ${(z + oz).toFixed(2)}\u00a0m`;
}

const degrees = (radians: number) => `${degreesOf(radians).toFixed(1)}°`;

/** Clockwise from north. */
function azimuth(east: number, north: number): string {
  return `${(((Math.atan2(east, north) * 180) / Math.PI + 360) % 360).toFixed(0)}° from north`;
}

const slopeText = (normal: Vec3) => degrees(slopeOf(normal));

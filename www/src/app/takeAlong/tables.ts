/** The numbers behind the figures as tables: a record a row, lengths in metres, angles in degrees, places in images in pixels. */

import { isVerifiedSet } from "../../shared/proposed";
import type { Vec3 } from "../../shared/records";
import { likeliestClass } from "../../shared/surfaceClass";
import type { Figure } from "../../stages/figure";
import type { Tab } from "../state/methods";

export type Row = Record<string, string | number | boolean | null>;

/** What each view of a stage shows as numbers. */
export const ROWS: Record<Tab, (figure: Figure) => Row[]> = {
  images: viewRows,
  segments: segmentRows,
  matches: candidateRows,
  lines: lineRows,
  halfplanes: similarityRows,
  coplanar: coplanarRows,
  adjacency: cornerRows,
  dense: denseRows,
  groups: groupRows,
  facets: facetRows,
  refinement: relationRows,
  regions: regionRows,
  directions: directionRows,
  clusters: clusterRows,
  rectangles: rectangleRows,
  model: facetRows,
};

const degrees = (radians: number) => (radians * 180) / Math.PI;
const nameOf = ({ scene }: Figure, view: number) => scene?.views[view]?.name ?? String(view);

/** The cameras: centre, and the projection matrix row by row. */
function viewRows({ scene }: Figure): Row[] {
  return (scene?.views ?? []).map(({ name, width, height, center: [x, y, z], projection }) => ({
    view: name,
    width,
    height,
    x,
    y,
    z,
    ...Object.fromEntries(
      [...projection].map((value, i) => [`p${Math.floor(i / 4) + 1}${(i % 4) + 1}`, value]),
    ),
  }));
}

function segmentRows(figure: Figure): Row[] {
  return figure.results.segments.flatMap((own, view) =>
    Array.from({ length: own.length / 4 }, (_, segment): Row => {
      const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = own.subarray(4 * segment, 4 * segment + 4);
      return { view: nameOf(figure, view), segment, x0, y0, x1, y1 };
    }),
  );
}

/** Candidates of the picked segment, and where each predicts it in third views. */
function candidateRows(figure: Figure): Row[] {
  const { story } = figure.detail;
  return (story?.candidates ?? []).flatMap(({ view, segment, score, line, predictions }, candidate) => {
    const own: Row = { candidate, view: nameOf(figure, view), segment, score, match: line };
    const thirds = predictions.map((one): Row => {
      const [x0, y0] = one.segment.p0;
      const [x1, y1] = one.segment.p1;
      const predicted = { third_view: nameOf(figure, one.view), x0, y0, x1, y1 };
      return { ...own, ...predicted, distance_px: one.distance_px, verified_by: one.verified };
    });
    const none = { third_view: null, x0: null, y0: null, x1: null, y1: null };
    return thirds.length > 0 ? thirds : [{ ...own, ...none, distance_px: null, verified_by: null }];
  });
}

/** Both correlation windows, pixel by pixel. */
export function windowRows({ detail: { correspondence } }: Figure): Row[] {
  const { window = [], other_window: other = [] } = correspondence ?? {};
  const side = Math.round(Math.sqrt(window.length));
  return window.map((value, i) => ({
    column: i % side,
    row: Math.floor(i / side),
    value,
    other_value: other[i] ?? null,
  }));
}

function lineRows({ results: { records, lines } }: Figure): Row[] {
  return records.map(({ origin, probability, sigma_m, supports }, line) => ({
    line,
    origin,
    ...ends(lines, line),
    views: supports.length,
    sigma_m,
    probability,
  }));
}

/** Sim(theta) of the picked side, and of each view by itself. */
function similarityRows(figure: Figure): Row[] {
  const { thetas, similarity, views } = figure.detail.side?.curve ?? {
    thetas: [],
    similarity: [],
    views: [],
  };
  return thetas.map((theta, i) => ({
    theta_deg: degrees(theta),
    sim: similarity[i] ?? null,
    ...Object.fromEntries(views.map((one) => [`sim_${nameOf(figure, one.view)}`, one.similarity[i] ?? null])),
  }));
}

function groupRows({ results: { grouping } }: Figure): Row[] {
  return (grouping?.groups ?? []).map(({ plane, members }, group) => ({
    group,
    ...planeOf(plane),
    lines: new Set(members.map(({ line }) => line)).size,
    half_planes: members.filter(({ half_plane }) => half_plane !== null).length,
  }));
}

/** Corners of the facets, in their order. */
function facetRows({ results: { facets } }: Figure): Row[] {
  return (facets ?? []).flatMap(({ outer, plane, similarity, real_ratio, probability }, facet) =>
    outer.map(([x, y, z], corner) => ({
      facet,
      corner,
      x,
      y,
      z,
      ...planeOf(plane),
      similarity,
      real_ratio,
      probability,
    })),
  );
}

function relationRows({ results: { refinement } }: Figure): Row[] {
  return (refinement?.buildings ?? []).flatMap(({ relations }, building) =>
    relations.map(({ kind, deviation_m, chi2, adopted }) => ({ building, kind, deviation_m, chi2, adopted })),
  );
}

function denseRows({ results: { dense } }: Figure): Row[] {
  return (dense?.planes ?? []).map(({ plane, patches, ...of }, index) => ({
    plane: index,
    ...planeOf(plane),
    patches: patches.length,
    class: likeliestClass(of.class).name,
    probability: likeliestClass(of.class).probability,
  }));
}

function coplanarRows({ results: { coplanar } }: Figure): Row[] {
  return (coplanar?.sets ?? []).flatMap((set, index) =>
    set.polygon.map(([x, y, z], corner) => ({
      set: index,
      corner,
      x,
      y,
      z,
      lines: set.lines.length,
      coplanar_nats: set.coplanar_nats,
      inside_nats: set.inside_nats,
      outline_nats: set.outline_nats,
      verified: isVerifiedSet(set),
    })),
  );
}

function cornerRows({ results: { adjacency } }: Figure): Row[] {
  return (adjacency?.trace.corners ?? []).map(({ at: [x, y, z], images, edges }, corner) => ({
    corner,
    x,
    y,
    z,
    views: images.length,
    edges: edges.length,
  }));
}

function regionRows(figure: Figure): Row[] {
  return figure.results.regions.flatMap(({ regions }, view) =>
    regions.map(({ mean, rings }, region) => ({
      view: nameOf(figure, view),
      region,
      mean,
      corners: rings[0]?.length ?? 0,
    })),
  );
}

/** The histogram of azimuths of the building that is shown. */
function directionRows({ results: { directions }, plane }: Figure): Row[] {
  const found = directions?.trace.histograms[plane];
  return (found?.histogram ?? []).map((weight, bin) => ({
    azimuth_deg: (bin + 0.5) * (found?.bin_deg ?? 1),
    weight,
  }));
}

function clusterRows({ results: { clusters }, plane }: Figure): Row[] {
  const trace = clusters?.[plane];
  const rows = (of: NonNullable<typeof trace>["selected"], selected: boolean) =>
    of.map(([[across_m, height_m], gain_bit]) => ({ across_m, height_m, gain_bit, selected }));
  return trace === undefined
    ? []
    : [
        ...rows(trace.selected, true),
        ...trace.refused.map(([[across_m, height_m]]) => ({
          across_m,
          height_m,
          gain_bit: null,
          selected: false,
        })),
      ];
}

function rectangleRows({ results: { rectangles } }: Figure): Row[] {
  return (rectangles?.pairs ?? []).map(({ lines: [first, second], rejection, crossings, ends: found }) => ({
    first,
    second,
    rejection,
    crossings: crossings.length,
    ends: found.length,
  }));
}

function ends(lines: Float64Array | null, line: number): Row {
  const [x0, y0, z0, x1, y1, z1] = lines?.subarray(6 * line, 6 * line + 6) ?? [];
  const all = { x0, y0, z0, x1, y1, z1 };
  return Object.fromEntries(Object.entries(all).map(([name, value]) => [name, value ?? null]));
}

function planeOf({ normal, d }: { normal: Vec3; d: number }): Row {
  const [nx, ny, nz] = normal;
  return { nx, ny, nz, d };
}

/** RFC 4180: commas, quotes where they are needed, lines end with CR LF. */
export function csvOf(rows: readonly Row[]): string {
  const names = [...new Set(rows.flatMap((row) => Object.keys(row)))];
  const field = (value: unknown) => {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const line = (values: readonly unknown[]) => `${values.map(field).join(",")}\r\n`;
  return line(names) + rows.map((row) => line(names.map((name) => row[name]))).join("");
}

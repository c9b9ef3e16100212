/** A line in space: what made it, view by view, and what it is part of. */
import { CONTRADICTION_WORDS, ORIGIN_WORDS, REJECTION_WORDS } from "../../app/parts/reasonText";
import { LINE_STRIDE } from "../../shared/flatArrays";
import type { HalfPlane, LineRecord } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import { viewName } from "../../stages/figure";
import { evidenceRow, probabilityRow } from "../parts/evidenceRows";
import type { About, Kind } from "../parts/kind";
import {
  azimuthText,
  degreesText,
  linksWhere,
  numbered,
  type Related,
  type Row,
  type Rows,
  worldText,
} from "../parts/rows";
import { lineEnds, linesShape } from "../parts/shapes";

export default {
  title: "3D line",
  rows({ index }, about) {
    const [p0, p1] = lineEnds(index, about.results);
    if (p0 === undefined || p1 === undefined) {
      return [];
    }
    const [dx, dy, dz] = [p1[0] - p0[0], p1[1] - p0[1], p1[2] - p0[2]];
    const plan = Math.hypot(dx, dy);
    const record = about.results.records[index];
    return [
      ["Length", `${Math.hypot(plan, dz).toFixed(2)} m`],
      ["Slope", degreesText(Math.atan2(dz, plan))],
      ["Azimuth", azimuthText(dx, dy)],
      ["Start", worldText(about.scene, p0)],
      ["End", worldText(about.scene, p1)],
      ...(record === undefined ? [] : recordRows(record, about)),
      ...consequences(index, about),
    ];
  },
  siblings: (_, { results: { lines } }) => numbered("line", (lines?.length ?? 0) / LINE_STRIDE),
  shapes: ({ index }, results) => linesShape([index], results),
  lines: ({ index }) => [index],
  /** The side of its better half-plane, or its left one. */
  question({ index }, { halfPlanes }) {
    const own = halfPlanes?.filter(({ line }) => line === index) ?? [];
    const better = (a: HalfPlane | null, b: HalfPlane) =>
      a !== null && a.similarity >= b.similarity ? a : b;
    const side = own.reduce<HalfPlane | null>(better, null)?.side ?? "left";
    return halfPlanes && { about: "side", line: index, side };
  },
} satisfies Kind<"line">;

/** How it was found. */
function recordRows(record: LineRecord, about: About): Rows {
  // In object space nothing is matched: the score is the share of the line that boundaries cover.
  const isClustered = about.results.clusters !== null;
  const { origin, contradiction, probability, by_views, in_model, sigma_m, supports } = record;
  return [
    ["Found", ORIGIN_WORDS[isClustered ? "clustered" : origin]],
    contradiction != null && ["Contradicted", CONTRADICTION_WORDS[contradiction]],
    probabilityRow(probability, (by_views ?? in_model ?? null) !== null),
    evidenceRow("For and against it, by its views (nats)", by_views),
    evidenceRow("For and against it, in the model (nats)", in_model),
    ["σ across", `${(100 * sigma_m).toFixed(1)} cm`],
    ...supports.map(({ view, segments, kind, score }): Row => {
      const to = (index: number): Related => ({
        name: String(numberOf(index)),
        selection: { kind: "segment", view, index },
      });
      const note = isClustered ? `show ${Math.round(100 * score)} % of it` : `${kind} ${score.toFixed(2)}`;
      return [viewName(about, view), segments.map(to), note];
    }),
  ];
}

/** What became of it. */
function consequences(index: number, { results: { halfPlanes, sides, grouping, facets } }: About): Rows {
  return [
    linksWhere("Half-planes", "halfplane", halfPlanes, ({ line }) => line === index),
    ...sides.map(
      ({ line, side, rejection }) =>
        line === index &&
        rejection !== null &&
        ([`Rejected, ${side}`, REJECTION_WORDS[rejection] ?? rejection] as const),
    ),
    linksWhere("Groups", "group", grouping?.groups, ({ members }) =>
      members.some(({ line }) => line === index),
    ),
    linksWhere("Facets", "facet", facets, ({ lines }) => lines?.includes(index) === true),
  ];
}

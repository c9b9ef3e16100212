/** A pair of parallel lines in space, its window, and the image lines inside it (W96 3.6, figures 10 and 11). */
import { PAIR_WORDS } from "../../app/parts/reasonText";
import { add, dot, norm, sub, unit } from "../../shared/linear";
import { PALETTE } from "../../shared/palette";
import type { PlaneCandidate, PlaneTrace, Vec3 } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { type Mark, type Seen, seenFrom, shapeMarks } from "../parts/marks";
import { indicesOf, links, numbered, type Row } from "../parts/rows";
import { lineEnds, linesShape } from "../parts/shapes";

export default {
  title: ({ index }, { results }) =>
    `Pair of lines ${linesOfPair(index, results).map(numberOf).join(" and ")}`,
  rows({ index }, { results: { rectangles, facets } }) {
    const pair = rectangles?.pairs[index];
    if (rectangles == null || pair === undefined) {
      return [];
    }
    const isOfPair = ({ lines }: { lines?: readonly number[] | undefined }) =>
      lines?.length === 2 && lines.every((line) => pair.lines.includes(line));
    const candidate = rectangles.candidates.find(isOfPair);
    return [
      links("3D lines", "line", pair.lines),
      ["Lines that cross", String(pair.crossings.length)],
      ["Ends found", String(pair.ends.length)],
      pair.rejection !== null && ["Rejected", PAIR_WORDS[pair.rejection] ?? pair.rejection],
      ...(candidate === undefined ? [] : candidateRows(candidate)),
      links("Facets", "facet", indicesOf(facets, isOfPair)),
    ];
  },
  siblings: (_, { results: { rectangles } }) => numbered("pair", rectangles?.pairs.length),
  shapes: ({ index }, results) => linesShape(linesOfPair(index, results), results),
  marks: ({ index }, seen) => [
    ...windowMarks(index, seen),
    ...shapeMarks(linesShape(linesOfPair(index, seen.results), seen.results), seen.info),
  ],
  lines: ({ index }, results) => linesOfPair(index, results),
} satisfies Kind<"pair">;

function linesOfPair(index: number, { rectangles }: Results): readonly number[] {
  return rectangles?.pairs[index]?.lines ?? [];
}

function candidateRows({ features, correlation }: PlaneCandidate): Row[] {
  const { outline_on_lines, plane_nats_per_m2, displaced_plane_margin_nats_per_m2 } = features;
  return [
    ["Outline covered", `${Math.round(100 * outline_on_lines)} %`],
    ["Correlation inside", correlation.toFixed(2)],
    ["Views for the plane", `${plane_nats_per_m2.toFixed(1)} nats/m²`],
    ["... more than beside it", `${displaced_plane_margin_nats_per_m2.toFixed(1)} nats/m²`],
  ];
}

/** The window of a pair of lines and what crosses it in this view (W96 figure 10). */
function windowMarks(index: number, { view, info, results }: Seen): Mark[] {
  const pair = results.rectangles?.pairs[index];
  const found = pair === undefined ? null : windowOf(pair, results);
  return found === null
    ? []
    : [
        ...seenFrom(info, found.outline, { colour: PALETTE.beam, width: 1, closed: true, fill: 0.1 }),
        ...found.crossings
          .filter((one) => one.view === view)
          .flatMap(({ ends }) => seenFrom(info, ends, { colour: PALETTE.grown, width: 2 })),
      ];
}

interface PlaneWindow {
  /** Around both lines. */
  outline: readonly Vec3[];
  /** The image lines that cross it, cut with its plane. */
  crossings: readonly { view: number; ends: readonly [Vec3, Vec3] }[];
}

/** Positions along the lines count from where the plane across them through the origin cuts them, as in the core. */
export function windowOf(
  { lines, crossings }: PlaneTrace,
  results: Pick<Results, "lines">,
): PlaneWindow | null {
  const [a, b] = lineEnds(lines[0], results);
  const [c, d] = lineEnds(lines[1], results);
  if (a === undefined || b === undefined || c === undefined || d === undefined) {
    return null;
  }
  const u = unit(sub(b, a));
  const [first, second] = [foot(a, u), foot(c, u)];
  const across = sub(second, first);
  const width = norm(across);
  /** `t` along the lines, `w` from the first to the second. */
  const at = (t: number, w: number) => add(add(first, u, t), across, w / width);
  const reach = [a, b, c, d].map((p) => dot(p, u));
  const [from, to] = [Math.min(...reach), Math.max(...reach)];
  return {
    outline: [at(from, 0), at(to, 0), at(to, width), at(from, width)],
    crossings: crossings.map(({ view, at: [t0, t1], across: [w0, w1] }) => {
      const along = (w: number) => t0 + ((t1 - t0) * w) / width;
      return { view, ends: [at(along(w0), w0), at(along(w1), w1)] };
    }),
  };
}

/** Where the line through a point cuts the plane across it through the origin. */
function foot(p: Vec3, u: Vec3): Vec3 {
  return add(p, u, -dot(p, u));
}

/** A side of a 3D line, whether it has a half-plane or not (B99 4.1). */
import { REJECTION_WORDS } from "../../app/parts/reasonText";
import { numberOf, type Selection } from "../../shared/selection";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { indicesOf, links } from "../parts/rows";
import { linesShape } from "../parts/shapes";

export default {
  title: ({ line, side }) => `3D line ${numberOf(line)}, ${side} side`,
  rows({ line, side }, { results: { sides, halfPlanes } }) {
    const isOwn = (one: { line: number; side: string }) => one.line === line && one.side === side;
    const rejection = sides.find(isOwn)?.rejection;
    return [
      links("3D line", "line", [line]),
      links("Half-plane", "halfplane", indicesOf(halfPlanes, isOwn)),
      rejection != null && ["Rejected", REJECTION_WORDS[rejection] ?? rejection],
    ];
  },
  siblings: (_, { results }) => allSides(results),
  shapes: ({ line }, results) => linesShape([line], results),
  lines: ({ line }) => [line],
  question: ({ line, side }, { halfPlanes }) => halfPlanes && { about: "side", line, side },
} satisfies Kind<"side">;

/** Every side of every line: its half-plane where it has one. */
export function allSides({ halfPlanes, sides }: Results): readonly Selection[] {
  const own = new Map(halfPlanes?.map(({ line, side }, index) => [`${line} ${side}`, index]));
  return sides.map(({ line, side }) => {
    const index = own.get(`${line} ${side}`);
    return index === undefined ? { kind: "side", line, side } : { kind: "halfplane", index };
  });
}

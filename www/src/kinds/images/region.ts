/** A region of a view (W96 3.3). */
import { grouped } from "../../app/parts/numberText";
import type { Kind } from "../parts/kind";
import { AREA } from "../parts/marks";
import { allOf, type Row } from "../parts/rows";

const MOVES: Record<string, string> = { dropped: "Break points dropped", merged: "Regions merged" };

export default {
  title: "Region",
  rows({ view, index }, { results }) {
    const found = results.regions[view];
    const region = found?.regions[index];
    return found === undefined || region === undefined
      ? []
      : [
          ["Area", `${grouped(region.area_px)} px`],
          ["Perimeter", `${region.perimeter_px.toFixed(0)} px`],
          ["Mean grey value", region.mean.toFixed(1)],
          ["Standard deviation", Math.sqrt(region.variance).toFixed(1)],
          ["Regions at the start", grouped(found.initial_regions)],
          ...Object.entries(found.moves).map(([move, count]): Row => [MOVES[move] ?? move, grouped(count)]),
        ];
  },
  siblings(picked, about) {
    const view = picked?.view ?? Math.max(0, about.view);
    const count = about.results.regions[view]?.regions.length;
    return allOf(count, (index) => ({ kind: "region", view, index }));
  },
  marks: ({ view: own, index }, { view, results }) =>
    own === view
      ? (results.regions[view]?.regions[index]?.rings ?? []).map((ring) => ({ points: ring, ...AREA }))
      : [],
} satisfies Kind<"region">;

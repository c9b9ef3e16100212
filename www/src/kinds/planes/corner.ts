/** A corner in space with its edges and regions (B99 2: Bonn). */
import { counted } from "../../app/parts/counted";
import { edgesOfCorner, isVerifiedPlane } from "../../shared/proposed";
import { cornerPlanesOf } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import type { Results } from "../../stages/list";
import type { Kind } from "../parts/kind";
import { groupsAndFacets, indicesOf, links, numbered } from "../parts/rows";
import { areas, openLine } from "../parts/shapes";

export default {
  title: "Corner",
  rows({ index }, { results }) {
    const { adjacency } = results;
    const corner = adjacency?.trace.corners[index];
    if (adjacency == null || corner === undefined) {
      return [];
    }
    const planes = planesOfCorner(index, results);
    const verified = planes.filter((i) => isVerifiedPlane(adjacency.planes[i]));
    const inside = verified.map((i) => ({
      name: `plane ${numberOf(i)}`,
      nats: adjacency.planes[i]?.inside_nats ?? 0,
    }));
    const sigmas = corner.covariance.map((row, i) => Math.sqrt(row[i] ?? 0));
    const neighbours = corner.edges.flatMap(({ neighbour }) => (neighbour === null ? [] : [neighbour]));
    return [
      ["Place", corner.at.map((v) => v.toFixed(2)).join(", "), "m"],
      ["Uncertainty", sigmas.map((v) => `± ${(100 * v).toFixed(0)}`).join(", "), "cm"],
      ["Seen in", counted(corner.images.length, "views"), counted(corner.edges.length, "edges")],
      [
        "For and against it (nats)",
        {
          bars: [
            { name: "places in the views", nats: corner.place_nats },
            { name: "directions of its edges", nats: corner.edges.reduce((sum, { nats }) => sum + nats, 0) },
            { name: "colours of its regions", nats: corner.color_nats },
          ],
        },
      ],
      links("Joined by an edge", "corner", [...new Set(neighbours)]),
      ["Planes that it proposes", String(planes.length), `verified: ${verified.length}`],
      inside.length > 0 && ["Views agree inside (nats)", { bars: inside }],
      ...groupsAndFacets(results, (one) => cornerPlanesOf(one).some((plane) => planes.includes(plane))),
    ];
  },
  siblings: (_, { results: { adjacency } }) => numbered("corner", adjacency?.trace.corners.length),
  /** Its edges, and the planes of the regions between them that the photographs verify. */
  shapes({ index }, results) {
    const { planes = [], trace } = results.adjacency ?? {};
    const corner = trace?.corners[index];
    if (trace === undefined || corner === undefined) {
      return [];
    }
    const own = planesOfCorner(index, results).flatMap((i) => planes[i] ?? []);
    return [
      ...areas(own.filter(isVerifiedPlane).map(({ polygon }) => polygon)),
      ...edgesOfCorner(corner, trace.corners).flatMap(openLine),
    ];
  },
} satisfies Kind<"corner">;

/** The planes that a corner proposes. */
export function planesOfCorner(index: number, { adjacency }: Pick<Results, "adjacency">): number[] {
  return indicesOf(adjacency?.planes, ({ regions }) => regions.some(([corner]) => corner === index));
}

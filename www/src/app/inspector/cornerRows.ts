/** A corner in space with its edges and regions (B99 2: Bonn), for the inspector. */

import { isVerifiedPlane } from "../../shared/proposed";
import { cornerPlanesOf } from "../../shared/records";
import { counted } from "../parts/counted";
import { results } from "../state/results";
import { indicesOf, linkToCorner, linkToFacet, linkToGroup, type Row } from "./rowLinks";

/** The planes that a corner proposes. */
export function planesOfCorner(index: number): number[] {
  const planes = results.value.adjacency?.planes;
  return indicesOf(planes, ({ regions }) => regions.some(([corner]) => corner === index));
}

export function cornerRows(index: number): Row[] {
  const { adjacency, grouping, facets } = results.value;
  const corner = adjacency?.trace.corners[index];
  if (adjacency == null || corner === undefined) {
    return [];
  }
  const planes = planesOfCorner(index);
  const verified = planes.filter((i) => isVerifiedPlane(adjacency.planes[i]));
  const inside = verified.map((i) => adjacency.planes[i]?.inside_nats ?? 0);
  const sigmas = corner.covariance.map((row, i) => Math.sqrt(row[i] ?? 0));
  const neighbours = corner.edges.flatMap(({ neighbour }) => (neighbour === null ? [] : [neighbour]));
  const has = (one: Parameters<typeof cornerPlanesOf>[0]) =>
    cornerPlanesOf(one).some((plane) => planes.includes(plane));
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
    ["Joined by an edge", [...new Set(neighbours)].map(linkToCorner)],
    ["Planes that it proposes", String(planes.length), `verified: ${verified.length}`],
    ...(inside.length === 0
      ? []
      : [
          [
            "Views agree inside (nats)",
            { bars: inside.map((nats, i) => ({ name: `plane ${verified[i]}`, nats })) },
          ] as const,
        ]),
    ...(grouping === null ? [] : [["Groups", indicesOf(grouping.groups, has).map(linkToGroup)] as const]),
    ...(facets === null ? [] : [["Facets", indicesOf(facets, has).map(linkToFacet)] as const]),
  ];
}

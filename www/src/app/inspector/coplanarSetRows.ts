/** A set of coplanar lines and its polygon (B99 2), for the inspector. */
import { type CoplanarRelationKind, coplanarSetsOf } from "../../shared/records";
import { counted } from "../parts/counted";
import { degreesOf, slopeOf } from "../parts/numberText";
import { results } from "../state/results";
import { slopeSigma } from "./densePlaneRows";
import { indicesOf, linkToFacet, linkToGroup, linkToLine, type Row } from "./rowLinks";

const RELATION_WORDS: Record<CoplanarRelationKind, string> = {
  square: "square corner",
  level: "level side",
  symmetric: "slope as across the ridge",
};

export function coplanarSetRows(index: number): Row[] {
  const { coplanar, grouping, facets } = results.value;
  const set = coplanar?.sets[index];
  const trace = coplanar?.trace.sets[index];
  if (set === undefined || trace === undefined) {
    return [];
  }
  const nats = set.inside_nats + set.outline_nats;
  const degrees = (radians: number) => `${degreesOf(radians).toFixed(1)}°`;
  const [before, after] = trace.reprojection_px;
  const of = trace.closing.map(({ kind, nats }) => ({
    name: kind === "square" ? "side made square" : "side mirrored",
    nats,
  }));
  const relations = trace.relations.map(({ kind, nats }) => ({ name: RELATION_WORDS[kind], nats }));
  const has = (one: Parameters<typeof coplanarSetsOf>[0]) => coplanarSetsOf(one).includes(index);
  return [
    ["Verified", nats > 0 ? "yes" : "no", `${nats.toFixed(1)} nats for it`],
    ["3D lines", set.lines.map(linkToLine)],
    [
      "For and against it (nats)",
      {
        bars: [
          { name: "ends of its lines in one plane", nats: set.coplanar_nats },
          { name: "views agree inside", nats: set.inside_nats },
          { name: "outline, as far as no view shows it", nats: set.outline_nats },
        ],
      },
    ],
    ["Slope", `${degrees(slopeOf(set.plane.normal))} ± ${degrees(slopeSigma(set))}`],
    [
      "Reprojection error",
      `${before.toFixed(2)} px, then ${after.toFixed(2)} px`,
      counted(trace.edges, "image edges"),
    ],
    ...(of.length === 0 ? [] : [["Sides without a line (nats)", { bars: of }] as const]),
    ...(relations.length === 0 ? [] : [["Relations (nats)", { bars: relations }] as const]),
    ...(grouping === null ? [] : [["Groups", indicesOf(grouping.groups, has).map(linkToGroup)] as const]),
    ...(facets === null ? [] : [["Facets", indicesOf(facets, has).map(linkToFacet)] as const]),
  ];
}

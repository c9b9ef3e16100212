/** A facet of the model (B99 4.3). */
import { refinementWords } from "../../app/parts/reasonText";
import { type Facet, isMadeFrom } from "../../shared/records";
import { slopedArea } from "../../shared/surfaceClass";
import type { Results } from "../../stages/list";
import { probabilityRow } from "../parts/evidenceRows";
import type { Kind } from "../parts/kind";
import { obstructionText } from "../parts/obstructionText";
import { buildingOfFacet } from "../parts/refinedBuildings";
import {
  azimuthText,
  indicesOf,
  links,
  linkTo,
  numbered,
  numberRow,
  type Row,
  slopeText,
} from "../parts/rows";
import { facetShape } from "../parts/shapes";
import { proposalRows } from "../planes/group";

export default {
  title: "Facet",
  rows({ index }, { results }) {
    const facet = results.facets?.[index];
    if (facet === undefined) {
      return [];
    }
    const [nx, ny] = facet.plane.normal;
    const { lines = [], half_planes = [], obstructions = [], uncertainty } = facet;
    const groups = indicesOf(results.grouping?.groups, (group) => isMadeFrom(facet, group));
    return [
      numberRow("Building", facet.building),
      ["Area", `${slopedArea(facet).toFixed(1)} m²`],
      ["Slope", `${slopeText(facet.plane.normal)}${plusMinus(uncertainty?.slope_deg, "°")}`],
      ["Falls towards", Math.hypot(nx, ny) < 0.02 ? "level" : azimuthText(nx, ny)],
      ["Corners", `${facet.outer.length + facet.holes.flat().length}${plusMinus(cornerSigma(facet), " m")}`],
      uncertainty && ["Height in its middle", `± ${uncertainty.height_m.toFixed(2)} m`],
      ["Similarity", facet.similarity.toFixed(3)],
      ["Outline on real lines, τ", facet.real_ratio === undefined ? "–" : facet.real_ratio.toFixed(2)],
      probabilityRow(facet.probability),
      ...obstructions.map((one, i): Row => [`Obstruction ${i + 1}`, obstructionText(one)]),
      links("3D lines", "line", lines),
      groups.length > 0 && links("Groups", "group", groups),
      refinedRow(index, results),
      ...(results.grouping === null ? [] : proposalRows(facet, results)),
      half_planes.length > 0 && links("Half-planes", "halfplane", half_planes),
    ];
  },
  siblings: (_, { results: { facets } }) => numbered("facet", facets?.length),
  shapes: ({ index }, results) => facetShape(index, results),
  lines: ({ index }, { facets }) => facets?.[index]?.lines ?? [],
  facet: ({ index }) => index,
} satisfies Kind<"facet">;

/** A standard deviation behind a value; nothing where it is not known. */
function plusMinus(sigma: number | undefined, unit: string): string {
  return sigma === undefined ? "" : ` ± ${sigma.toFixed(2)}${unit}`;
}

/** The median over the corners of their standard deviation in plan. */
function cornerSigma({ uncertainty }: Facet): number | undefined {
  const inPlan = (uncertainty?.corners ?? []).map(({ sigma_m: [x, y] }) => Math.hypot(x, y) / Math.SQRT2);
  inPlan.sort((a, b) => a - b);
  return inPlan[Math.floor(inPlan.length / 2)];
}

/** The refinement of the building that a facet is part of. */
function refinedRow(facet: number, results: Results): Row | null {
  const building = buildingOfFacet(facet, results);
  const found = results.refinement?.buildings[building ?? -1];
  return building === undefined || found === undefined
    ? null
    : ["Refined", [linkTo("refinement", building)], refinementWords(found)];
}

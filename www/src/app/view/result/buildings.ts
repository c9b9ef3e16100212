/** The buildings of the model, as they are listed, with the numbers that they have in the report and in the files. */
import type { Facet, Vec3 } from "../../../shared/records";
import { numberOf } from "../../../shared/selection";
import { slopedArea } from "../../../shared/surfaceClass";
import { degreesOf, slopeOf } from "../../parts/numberText";
import { doubtfulFacets } from "../../results/corrections/doubtful";

export interface RoofFace {
  /** Among the facets of the model. */
  index: number;
  /** Along the slope, square metres. */
  area: number;
  slopeDeg: number;
  probability: number;
  isDoubtful: boolean;
  outer: readonly Vec3[];
}

export interface Building {
  number: number;
  faces: RoofFace[];
  area: number;
  /** Of its least probable facet. */
  probability: number;
  doubtful: number;
}

export function buildings(facets: readonly Facet[]): Building[] {
  const doubtful = new Set(doubtfulFacets(facets));
  const byNumber = new Map<number, RoofFace[]>();
  facets.forEach((facet, index) => {
    const { building, plane, probability, outer } = facet;
    const slopeDeg = degreesOf(slopeOf(plane.normal));
    const isDoubtful = doubtful.has(index);
    const face = { index, area: slopedArea(facet), slopeDeg, probability, isDoubtful, outer };
    byNumber.set(building, [...(byNumber.get(building) ?? []), face]);
  });
  return [...byNumber]
    .sort(([a], [b]) => a - b)
    .map(([building, faces]) => ({
      number: numberOf(building),
      faces,
      area: faces.reduce((sum, { area }) => sum + area, 0),
      probability: Math.min(...faces.map(({ probability }) => probability)),
      doubtful: faces.filter(({ isDoubtful }) => isDoubtful).length,
    }));
}

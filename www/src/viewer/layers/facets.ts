/** Roof facets, tinted by their normal: the hue says where a facet faces, the saturation how steep it is. */

import {
  BufferGeometry,
  Color,
  LineBasicMaterial,
  LineSegments,
  type Mesh,
  type MeshBasicMaterial,
  ShapeUtils,
  Vector2,
  Vector3,
} from "three";
import { edgesOf } from "../../shared/linear";
import { PALETTE } from "../../shared/palette";
import type { Facet, Vec3 } from "../../shared/records";
import { numberOf } from "../../shared/selection";
import { opacityOf } from "../scene/certainty";
import { middleOf } from "../scene/facetPlan";
import { BEHIND_LINES, colouredMesh, type Layer } from "../scene/layer";
import { nameLabels } from "../scene/nameLabels";
import { partsLayer } from "../scene/partsLayer";
import { roofTint } from "../scene/roofTint";

const DIMMED = 0.3;
const OPACITY = 0.92;

/** @param areNamed by their numbers, which those of a preliminary model do not keep */
export function buildFacets(facets: readonly Facet[], areNamed = true): Layer {
  const triangles = facets.map(triangulate);
  const facetOfTriangle = triangles.flatMap((positions, i) =>
    new Array<number>(positions.length / 9).fill(i),
  );
  const opacities = facets.map(({ probability }) => opacityOf(probability));
  const drawn = facetMesh(triangles, facets.map(normalTint), opacities);
  const names = facets.map(({ outer }, i) => ({ text: String(numberOf(i)), at: middleOf(outer) }));
  return partsLayer({
    kind: "facet",
    parts: [{ drawn, opacity: [OPACITY, DIMMED], things: facetOfTriangle }],
    beside: [outlines(facets), ...(areNamed ? [nameLabels(names)] : [])],
    chosen: (index) => {
      const one = triangles[index];
      return one === undefined ? null : facetMesh([one], [new Color(PALETTE.selected)]);
    },
  });
}

/** The tint of a plane, for three. */
export function normalTint(facet: Pick<Facet, "plane">): Color {
  return new Color(...roofTint(facet));
}

/** Positions of a facet's triangles, nine numbers each; its plan is triangulated, roofs do not overhang. */
export function triangulate({ outer, holes }: Facet): number[] {
  const corners = [...outer, ...holes.flat()];
  const plan = (ring: readonly Vec3[]) => ring.map(([x, y]) => new Vector2(x, y));
  return ShapeUtils.triangulateShape(plan(outer), holes.map(plan)).flatMap((triangle) =>
    triangle.flatMap((index) => [...(corners[index] as Vec3)]),
  );
}

/** @param opacities of each facet, as a share of the material's; 1 where there is none */
export function facetMesh(
  triangles: readonly number[][],
  tints: readonly Color[],
  opacities: readonly number[] = [],
): Mesh<BufferGeometry, MeshBasicMaterial> {
  const colours = triangles.flatMap((positions, i) => {
    const tint = [...(tints[i] as Color).toArray(), opacities[i] ?? 1];
    return new Array(positions.length / 3).fill(tint).flat() as number[];
  });
  return colouredMesh(triangles.flat(), colours, null, { opacity: OPACITY, ...BEHIND_LINES });
}

function outlines(facets: readonly Facet[]): LineSegments {
  const points = facets.flatMap(({ outer, holes }) =>
    [outer, ...holes].flatMap((ring) => edgesOf(ring).flatMap((ends) => ends.map((p) => new Vector3(...p)))),
  );
  const material = new LineBasicMaterial({ color: PALETTE.casing, transparent: true, opacity: 0.7 });
  const lines = new LineSegments(new BufferGeometry().setFromPoints(points), material);
  lines.raycast = () => undefined;
  return lines;
}

import type { Mesh } from "three";
import { expect, it } from "vitest";
import type { Facet, Vec3 } from "../../../src/shared/records";
import { buildFacets } from "../../../src/viewer/layers/facets";

const OUTER: Vec3[] = [
  [0, 0, 5],
  [4, 0, 5],
  [0, 4, 5],
];
const facet = (probability?: number) =>
  ({ plane: { normal: [0, 0, 1], d: -5 }, outer: OUTER, holes: [], probability }) as unknown as Facet;

it("is the fainter the less probable it is", () => {
  const [mesh] = buildFacets([facet(0.98), facet(0.75), facet(0.55), facet()]).object.children as [Mesh];
  const colours = mesh.geometry.getAttribute("color");
  const opacities = Array.from({ length: colours.count }, (_, i) => colours.getW(i));
  const each = [1, 0.7, 0.5, 1].flatMap((opacity) => [opacity, opacity, opacity]);
  opacities.forEach((opacity, i) => {
    expect(opacity).toBeCloseTo(each[i] as number);
  });
});

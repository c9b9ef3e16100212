import { expect, test } from "vitest";
import { unmodelledPlanes } from "../../../src/app/view/space/unmodelledPlanes";
import type { Facet, RejectedFacet, Vec3 } from "../../../src/shared/records";

function square(x: number, y: number, side: number): Vec3[] {
  return [
    [x, y, 5],
    [x + side, y, 5],
    [x + side, y + side, 5],
    [x, y + side, 5],
  ];
}

const rejected = (outline: Vec3[], reason: object) => ({ group: 0, outline, reason }) as RejectedFacet;
const improbable = (nats: number) => ({ improbable: { evidence: { prior: nats, terms: [] } } });
const facet = (outer: Vec3[]) => ({ outer }) as Facet;

test("a roof side without a facet is named once, however often it was rejected", () => {
  const planes = [
    rejected(square(0, 0, 4), improbable(-1)),
    rejected(square(0, 0, 5), improbable(-2)),
    rejected(square(20, 0, 6), improbable(-0.1)),
  ];
  expect(unmodelledPlanes(planes, [])).toEqual([2, 1]);
});

test("what the model covers and what is no roof is not missing", () => {
  const planes = [
    rejected(square(0, 0, 4), improbable(-1)),
    rejected(square(20, 0, 6), improbable(-4)),
    rejected(square(40, 0, 6), { near_ground: { height_m: 0.3 } }),
  ];
  expect(unmodelledPlanes(planes, [facet(square(-1, -1, 8))])).toEqual([]);
});

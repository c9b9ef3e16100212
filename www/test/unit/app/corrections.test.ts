import { describe, expect, it } from "vitest";
import { doubtfulFacets, nextDoubtful } from "../../../src/app/results/corrections/doubtful";
import {
  facetAt,
  freeEdges,
  innerPoint,
  nearestEdge,
  nearestParallel,
  ridgeOf,
  ringOf,
} from "../../../src/app/results/corrections/facetGeometry";
import type { Facet, Vec3 } from "../../../src/shared/records";

/** A facet of so many corners whose plane rises northwards by `rise` from `z` at y = 0. */
function facet(plan: readonly (readonly [number, number])[], z: number, rise: number): Facet {
  const length = Math.hypot(rise, 1);
  const normal: Vec3 = [0, -rise / length, 1 / length];
  const outer = plan.map(([x, y]): Vec3 => [x, y, z + rise * y]);
  return { outer, holes: [], plane: { normal, d: -z / length }, probability: 1 } as unknown as Facet;
}

const GABLE = [
  facet(
    [
      [-6, -4],
      [6, -4],
      [6, 0],
      [-6, 0],
    ],
    9,
    0.75,
  ),
  facet(
    [
      [-6, 0],
      [6, 0],
      [6, 4],
      [-6, 4],
    ],
    9,
    -0.75,
  ),
];

describe("the place of a facet", () => {
  it("lies inside it, also where its middle does not", () => {
    const angled = facet(
      [
        [0, 0],
        [10, 0],
        [10, 2],
        [2, 2],
        [2, 10],
        [0, 10],
      ],
      5,
      0.5,
    );
    const [x, y, z] = innerPoint(angled);
    expect(facetAt([angled], [x, y])).toBe(0);
    expect(z).toBeCloseTo(5 + 0.5 * y, 9);
    expect(facetAt(GABLE, [0, 2])).toBe(1);
    expect(facetAt(GABLE, [0, 5])).toBe(-1);
  });
});

describe("edges", () => {
  it("are free where no other facet has them", () => {
    expect(freeEdges(GABLE, 0)).toHaveLength(3);
    expect(freeEdges(GABLE.slice(0, 1), 0)).toHaveLength(4);
  });

  it("have a counterpart beyond the highest level one", () => {
    const ridge = ridgeOf(GABLE.slice(0, 1), 0);
    expect(ridge?.map(([, y, z]) => [y, z])).toEqual([
      [0, 9],
      [0, 9],
    ]);
    const eave = ridgeOf(GABLE, 0);
    expect(eave?.[0]?.[2]).toBe(6);
  });

  it("have it beyond the ridge, not beyond a step at its end that stands a little higher", () => {
    const stepped = facet(
      [
        [-6, -4],
        [6, -4],
        [6, 0.1],
        [5.7, 0.1],
        [5.7, 0],
        [-6, 0],
      ],
      9,
      0.75,
    );
    const ridge = ridgeOf([stepped], 0);
    expect(ridge?.map(([x]) => x)).toEqual([5.7, -6]);
  });

  it("make a ring that does not cross itself, whichever way they were drawn", () => {
    const [a, b, c, d]: Vec3[] = [
      [0, 0, 0],
      [4, 0, 0],
      [4, 3, 0],
      [0, 3, 0],
    ] as Vec3[] as [Vec3, Vec3, Vec3, Vec3];
    expect(ringOf([a, b], [c, d])).toEqual([a, b, c, d]);
    expect(ringOf([a, b], [d, c])).toEqual([a, b, c, d]);
  });

  it("are joined to the nearest one of the selected facet", () => {
    const eave = [
      [-6, 4, 6],
      [6, 4, 6],
    ] as unknown as [Vec3, Vec3];
    expect(nearestEdge(GABLE.slice(0, 1), 0, eave)?.[0]?.[2]).toBe(9);
  });
});

describe("edges that are nearly parallel", () => {
  it("are the longest one and the one that runs as it does, whichever way", () => {
    const skewed: Vec3[] = [
      [0, 0, 5],
      [2, 3, 5],
      [9, 3.4, 5],
      [11, 0, 5],
    ];
    expect(nearestParallel(skewed)).toEqual([1, 3]);
    expect(nearestParallel([...skewed].reverse())).toEqual([1, 3].map((i) => (2 - i + 4) % 4));
    // In space: an edge below another one in plan may rise.
    const rising: Vec3[] = [
      [0, 0, 0],
      [10, 0, 0],
      [10, 1, 8],
      [0, 1, 0.5],
    ];
    expect(nearestParallel(rising)).toEqual([0, 2]);
  });
});

describe("doubtful facets", () => {
  const facets = [0.99, 0.7, 0.2, 0.94, 1].map((probability) => ({ probability }));

  it("come by their probability, one after the other, and again from the first", () => {
    expect(doubtfulFacets(facets)).toEqual([2, 1, 3]);
    expect(nextDoubtful(facets, null)).toBe(2);
    expect(nextDoubtful(facets, 2)).toBe(1);
    expect(nextDoubtful(facets, 3)).toBe(2);
    expect(nextDoubtful(facets, 0)).toBe(2);
    expect(nextDoubtful([{ probability: 1 }], null)).toBeNull();
  });
});

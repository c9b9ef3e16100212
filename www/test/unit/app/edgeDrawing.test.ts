import { beforeEach, describe, expect, it, vi } from "vitest";

const correct = vi.hoisted(() => vi.fn(() => Promise.resolve()));
vi.mock("../../../src/app/corrections/history", () => ({ correct }));
vi.mock("../../../src/app/state/scene", () => ({
  scene: { peek: () => ({ views: [{ name: "a.jpg" }, { name: "b.jpg" }] }) },
}));

import { drawEdge, edgeStart, isDrawingEdge, takeEdgeEnd } from "../../../src/app/corrections/edgeDrawing";

describe("an edge drawn in a photograph", () => {
  beforeEach(() => {
    correct.mockClear();
    drawEdge(true);
  });

  it("is corrected at the second click in the same photograph", async () => {
    await takeEdgeEnd(1, [10, 20]);
    expect(edgeStart.value).toEqual({ view: 1, at: [10, 20] });
    await takeEdgeEnd(1, [30, 40.5]);
    expect(correct).toHaveBeenCalledExactlyOnceWith({
      correction: "add_edge",
      photograph: "b.jpg",
      pixels: [
        [10, 20],
        [30, 40.5],
      ],
    });
    expect(isDrawingEdge.value).toBe(false);
    expect(edgeStart.value).toBeNull();
  });

  it("begins anew in another photograph", async () => {
    await takeEdgeEnd(1, [10, 20]);
    await takeEdgeEnd(0, [30, 40]);
    expect(edgeStart.value).toEqual({ view: 0, at: [30, 40] });
    expect(correct).not.toHaveBeenCalled();
  });

  it("takes no place once it is left", async () => {
    await takeEdgeEnd(1, [10, 20]);
    drawEdge(false);
    await takeEdgeEnd(1, [30, 40]);
    expect(correct).not.toHaveBeenCalled();
    expect(edgeStart.value).toBeNull();
  });
});

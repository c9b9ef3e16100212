import { beforeEach, describe, expect, it, vi } from "vitest";

const correct = vi.hoisted(() => vi.fn(() => Promise.resolve()));
vi.mock("../../../src/app/results/corrections/history", () => ({ correct }));
vi.mock("../../../src/app/state/scene", () => ({
  scene: { peek: () => ({ views: [{ name: "a.jpg" }, { name: "b.jpg" }] }) },
}));

import {
  drawEdge,
  edgeStart,
  isDrawingEdge,
  takeEdgeEnd,
} from "../../../src/app/results/corrections/edgeDrawing";

describe("an edge drawn in a photograph", () => {
  beforeEach(() => {
    correct.mockClear();
    drawEdge(true);
  });

  it("is corrected at the second click in the same photograph", async () => {
    await takeEdgeEnd(1, [10, 20], 1);
    expect(edgeStart.value).toEqual({ view: 1, at: [10, 20], scale: 1 });
    await takeEdgeEnd(1, [30, 40.5], 1);
    expect(correct).toHaveBeenCalledExactlyOnceWith({
      correction: "add_edge",
      photograph: "b.jpg",
      pixels: [
        [10, 20],
        [30, 40.5],
      ],
      sigma_px: 2,
    });
    expect(isDrawingEdge.value).toBe(false);
    expect(edgeStart.value).toBeNull();
  });

  it.each([
    { scales: [4, 4], sigma: 0.5 },
    { scales: [0.3, 0.3], sigma: 6.7 },
    // The end that was clicked in the smaller image is the less certain one.
    { scales: [1, 0.25], sigma: 8 },
  ])("is as certain as its pixels are shown large: $scales", async ({ scales: [first, second], sigma }) => {
    await takeEdgeEnd(1, [10, 20], first as number);
    await takeEdgeEnd(1, [300, 400], second as number);
    expect(correct).toHaveBeenCalledExactlyOnceWith(expect.objectContaining({ sigma_px: sigma }));
  });

  it("begins anew in another photograph", async () => {
    await takeEdgeEnd(1, [10, 20], 1);
    await takeEdgeEnd(0, [30, 40], 2);
    expect(edgeStart.value).toEqual({ view: 0, at: [30, 40], scale: 2 });
    expect(correct).not.toHaveBeenCalled();
  });

  it("takes no place once it is left", async () => {
    await takeEdgeEnd(1, [10, 20], 1);
    drawEdge(false);
    await takeEdgeEnd(1, [30, 40], 1);
    expect(correct).not.toHaveBeenCalled();
    expect(edgeStart.value).toBeNull();
  });
});

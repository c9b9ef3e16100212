import { expect, it } from "vitest";
import { layoutFor } from "../../../src/app/view/screen/layout";

it("a small screen, zoom and large type each take the layout that has room", () => {
  expect([360, 768, 1024, 1440, 1920].map((width) => layoutFor(width, 1))).toEqual([
    "phone",
    "stacked",
    "tight",
    "wide",
    "wide",
  ]);
  // 1440 pixels at 200 % zoom, and at 150 % type.
  expect(layoutFor(720, 1)).toBe("stacked");
  expect(layoutFor(1440, 1.5)).toBe("tight");
  expect(layoutFor(1024, 1.5)).toBe("stacked");
});

import { expect, it } from "vitest";
import { grouped } from "../../../src/app/parts/numberText";

it.each([0, 7, 999, 1000, -1000, 12345.6789, 1234567, -0.25, 0.1 + 0.2, 2e6, -999.9996])(
  "writes %d as English does",
  (value) => {
    expect(grouped(value)).toBe(value.toLocaleString("en", { maximumFractionDigits: 3 }));
  },
);

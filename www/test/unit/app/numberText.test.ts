import { expect, it } from "vitest";
import { grouped, percentText, signed } from "../../../src/app/parts/numberText";

it.each([0, 7, 999, 1000, -1000, 12345.6789, 1234567, -0.25, 0.1 + 0.2, 2e6, -999.9996])(
  "writes %d as English does",
  (value) => {
    expect(grouped(value)).toBe(value.toLocaleString("en", { maximumFractionDigits: 3 }));
  },
);

it("writes signs, but none of what rounds to nothing", () => {
  expect([0.42, -1.26, 0, -0.04, 3].map((value) => signed(value))).toEqual([
    "+0.4",
    "−1.3",
    "0.0",
    "0.0",
    "+3.0",
  ]);
});

it("calls only what is certain 0 or 100 %", () => {
  expect([0, 0.001, 0.125, 0.934, 0.9996, 1].map(percentText)).toEqual([
    "0 %",
    "< 1 %",
    "13 %",
    "93 %",
    "> 99 %",
    "100 %",
  ]);
});

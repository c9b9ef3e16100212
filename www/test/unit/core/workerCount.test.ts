import { expect, it } from "vitest";
import { automaticWorkers } from "../../../src/core/workerCount";

it("takes as many workers as cores and memory allow", () => {
  expect(automaticWorkers(1, 1e6)).toBe(1);
  expect(automaticWorkers(2, 1e6)).toBe(2);
  expect(automaticWorkers(8, 1e6)).toBe(7);
  expect(automaticWorkers(64, 1e6)).toBe(8);
  expect(automaticWorkers(8, 10e6)).toBe(4);
  expect(automaticWorkers(8, 500e6)).toBe(1);
});

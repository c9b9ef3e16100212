import { describe, expect, it } from "vitest";
import { failureNotice, splitAdvice } from "../../src/app/notices";

describe("splitAdvice", () => {
  it("separates what is wrong from what to do", () => {
    expect(splitAdvice("a.jpg: no orientation; add one")).toEqual({
      text: "a.jpg: no orientation",
      advice: "Add one",
    });
  });

  it("leaves a message without advice whole", () => {
    expect(splitAdvice("a.jpg: unreadable")).toEqual({ text: "a.jpg: unreadable" });
  });
});

describe("failureNotice", () => {
  it("always says what to do when the program is at fault", () => {
    expect(failureNotice("unreachable", "crash").advice).toMatch(/files are still here/);
    expect(failureNotice("odd", "internal").advice).toBeDefined();
  });
});

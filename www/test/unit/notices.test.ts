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

describe("the doctor's finding", () => {
  const refusal =
    "the images contradict their orientation: they agree to 0.04 as it stands, and to 0.61 if the angles are in gon; correct the orientation file";

  it("is offered as a fix", () => {
    expect(failureNotice(refusal, "input").fix).toEqual({
      before: 0.04,
      after: 0.61,
      words: "the angles are in gon",
    });
  });

  it("is offered for nothing else", () => {
    expect(failureNotice("fewer than three views; add photographs", "input")).not.toHaveProperty("fix");
    expect(failureNotice(refusal, "internal")).not.toHaveProperty("fix");
  });
});

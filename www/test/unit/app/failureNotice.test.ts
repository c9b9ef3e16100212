import { describe, expect, it } from "vitest";
import { failureNotice, splitAdvice } from "../../../src/app/session/failureNotice";
import { withNotice } from "../../../src/app/state/notices";
import type { AgreementReport } from "../../../src/shared/records";

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

describe("the orientation check", () => {
  const report: AgreementReport = {
    finding: "explained",
    stated: { points: 900, score: 0.04 },
    cured: { points: 910, score: 0.61 },
    offsets_px: null,
    mistake: "the angles are in gon",
    trials: [],
  };

  it("takes the place of the advice where the page can undo the mistake", () => {
    const notice = failureNotice("the images contradict; correct the file", "input", report);
    expect(notice.orientationCheck).toEqual(report);
    expect(notice).not.toHaveProperty("advice");
  });

  it("stands beside the advice where it cannot", () => {
    const notice = failureNotice("upside down; export again", "input", { ...report, mistake: null });
    expect(notice.advice).toBe("Export again");
    expect(failureNotice("fewer than three views; add some", "input")).not.toHaveProperty("orientationCheck");
  });
});

describe("withNotice", () => {
  it("shows once what is said again, and last", () => {
    const notice = (id: number, text: string) => ({
      id,
      severity: "error" as const,
      title: "Rejected",
      text,
    });
    const shown = withNotice([notice(1, "too low"), notice(2, "too dark")], notice(3, "too low"));
    expect(shown.map(({ id }) => id)).toEqual([2, 3]);
  });
});

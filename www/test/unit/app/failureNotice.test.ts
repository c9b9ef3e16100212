import { describe, expect, it, vi } from "vitest";
import {
  failureNotice,
  refusalNotices,
  splitAdvice,
  workerNotice,
} from "../../../src/app/session/failureNotice";
import { dismissAbout, notices, notify, withNotice } from "../../../src/app/state/notices";
import { EngineError } from "../../../src/core/engine";
import type { AgreementReport } from "../../../src/shared/records";

vi.mock("../../../src/pkg/ridgeline_bg.wasm?url", () => ({ default: "none" }));

describe("splitAdvice", () => {
  it("separates what is wrong from what to do", () => {
    expect(splitAdvice("a.jpg: no orientation; add one")).toEqual({
      text: "a.jpg: no orientation",
      advice: "Add one",
    });
  });

  it("names no option of the command line", () => {
    expect(splitAdvice("a.asc: in feet (--crs EPSG:N states the system); leave it out (--without)")).toEqual({
      text: "a.asc: in feet",
      advice: "Leave it out",
    });
  });

  it("leaves a message without advice whole", () => {
    expect(splitAdvice("a.zip: cannot be read: invalid Zip archive: Could not find EOCD; unpack it")).toEqual(
      {
        text: "a.zip: cannot be read: it is damaged or incomplete",
        advice: "Unpack it",
      },
    );
    expect(splitAdvice("a.jpg: unreadable")).toEqual({ text: "a.jpg: unreadable" });
  });
});

describe("failureNotice", () => {
  it("always says what to do when the program is at fault", () => {
    expect(failureNotice("odd", "internal").advice).toBeDefined();
    const crash = failureNotice("index 9 is out of bounds; the length is 9", "crash", null, "Facets");
    expect(crash.text).toBe("Facets: index 9 is out of bounds; the length is 9");
    expect(crash.advice).toMatch(/started again with your files/);
  });

  it("advises smaller images only where memory ran out", () => {
    expect(failureNotice("out of it", "memory").advice).toMatch(/smaller images/);
    expect(failureNotice("out of it", "crash").advice).not.toMatch(/smaller|fewer|memory/);
    expect(workerNotice(new EngineError("index 9", "crash")).text).toMatch(/index 9/);
    expect(workerNotice(new EngineError("index 9", "crash")).text).not.toMatch(/memory/);
    expect(workerNotice(new EngineError("", "memory")).text).toMatch(/memory/);
  });
});

describe("refusalNotices", () => {
  it("makes one box of one cause, with the names of all files and the core's words", () => {
    const cause = "a PDF, no photograph; save its pages as JPEG";
    const found = refusalNotices([
      `a.pdf: ${cause}`,
      "fewer than three views; add some",
      `b/c.pdf: ${cause}`,
    ]);
    expect(found.map(({ text, advice }) => [text, advice])).toEqual([
      ["a.pdf, b/c.pdf: a PDF, no photograph", "Save its pages as JPEG"],
      ["fewer than three views", "Add some"],
    ]);
    const many = refusalNotices([1, 2, 3, 4, 5].map((n) => `${n}.heic: ${cause}`));
    expect(many.map(({ text }) => text)).toEqual(["1.heic, 2.heic, 3.heic and 2 more: a PDF, no photograph"]);
  });

  it("counts what it does not show", () => {
    const found = refusalNotices([1, 2, 3, 4, 5].map((n) => `view ${n} is odd`));
    expect(found.map(({ text }) => text).at(-1)).toBe("There is one more problem.");
    expect(found).toHaveLength(5);
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

describe("another project", () => {
  it("takes the notices of the last one away, and leaves those about the browser", () => {
    notify({ severity: "error", title: "This input cannot be used", text: "" });
    notify({ severity: "warning", title: "No 3D view", text: "", about: "browser" });
    dismissAbout("project");
    expect(notices.value.map(({ title }) => title)).toEqual(["No 3D view"]);
  });
});

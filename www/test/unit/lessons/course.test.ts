/** The lessons as they are written: complete, every symbol with a meaning, every formula readable. */
import { beforeAll, describe, expect, it, vi } from "vitest";
import { lessonFormula, piecesOf, symbolsIn, symbolsOfText } from "../../../src/lessons/parts/formula";
import { type Lesson, wordsOf } from "../../../src/lessons/parts/lesson";
import { SYMBOLS } from "../../../src/lessons/parts/symbols";

const IDS = [
  "pinhole",
  "epipolar",
  "correlation",
  "trifocal",
  "triangulation",
  "lines-in-space",
  "homography",
  "roofs",
  "object-space",
  "evidence",
];

let lessons: readonly Lesson[] = [];

beforeAll(async () => {
  // What figures of real scenes want of a page when they are made.
  vi.stubGlobal("HTMLElement", class {});
  vi.stubGlobal("window", { matchMedia: () => ({ matches: false, addEventListener: () => {} }) });
  vi.stubGlobal("document", { documentElement: { dataset: {} } });
  lessons = (await import("../../../src/lessons/catalogue")).LESSONS;
});

describe("formulas", () => {
  it("are read with scripts, groups, fractions and matrices", () => {
    const node = lessonFormula("x2 ^T F x = 0");
    expect(node.children.map(({ tag }) => tag)).toEqual(["msup", "mi", "mi", "mo", "mn"]);
    expect(symbolsIn(node).map(({ glyph }) => glyph)).toEqual(["x′", "F", "x"]);
    expect(lessonFormula("frac { f B } { Z ^2 }").tag).toBe("mfrac");
    expect(JSON.stringify(lessonFormula("matrix { 1 -2 ; 3 { u + v } }"))).toContain("−2");
    expect(lessonFormula("sum _ i d _ i ^2").children[0]?.tag).toBe("munder");
  });

  it("are rejected where a word has no meaning or a group no end", () => {
    for (const wrong of ["x ~ Q X", "frac { f", "x }", "x ^"]) {
      expect(() => lessonFormula(wrong), wrong).toThrow();
    }
  });

  it("stand between words", () => {
    expect(piecesOf("a $x$ is *not* $X$.").map(({ kind }) => kind)).toEqual([
      "words",
      "formula",
      "words",
      "emphasis",
      "words",
      "formula",
    ]);
    expect(piecesOf("a $x$?").at(-1)).toEqual({ kind: "formula", text: "x", after: "?" });
    expect(symbolsOfText(["$x$ and $x$"])).toHaveLength(1);
  });
});

describe("symbols", () => {
  it("have one meaning each: no two look alike", () => {
    const looks = Object.values(SYMBOLS).map(
      ({ glyph, form, ...rest }) => `${form} ${glyph} ${"sub" in rest ? rest.sub : ""}`,
    );
    expect(new Set(looks).size).toBe(looks.length);
  });
});

describe("figures of one's own files", () => {
  it("share a scene if the files are the same", async () => {
    const { keyOfFiles } = await import("../../../src/element/RidgelineFigure");
    const files = [{ path: "a.jpg", blob: new Blob() }];
    expect(keyOfFiles(files)).toBe(keyOfFiles(files));
    expect(keyOfFiles([...files])).not.toBe(keyOfFiles(files));
  });
});

describe("the ten lessons", () => {
  it("are the ten, in their order, with names of their own", () => {
    expect(lessons.map(({ id }) => id)).toEqual(IDS);
    for (const { id, screens, minutes } of lessons) {
      const ids = screens.map((screen) => screen.id);
      expect(new Set(ids).size, id).toBe(ids.length);
      expect(screens.length, id).toBeGreaterThanOrEqual(4);
      expect(screens.length, id).toBeLessThanOrEqual(8);
      expect(minutes, id).toBeGreaterThanOrEqual(5);
      expect(minutes, id).toBeLessThanOrEqual(10);
    }
  });

  it("show a drawn figure first, a real scene last, and ask before they answer", () => {
    for (const { id, screens } of lessons) {
      expect(screens[0]?.isReal ?? false, id).toBe(false);
      expect(screens.at(-1)?.isReal, id).toBe(true);
      expect(screens.filter(({ predict }) => predict !== undefined).length, id).toBeGreaterThanOrEqual(2);
    }
  });

  it("can be read: every formula and every symbol has a meaning, and no number is missing", () => {
    for (const { id, screens } of lessons) {
      for (const screen of screens) {
        for (const text of wordsOf(screen)) {
          expect(text, `${id}/${screen.id}`).not.toMatch(/NaN|Infinity|undefined/);
          expect(() => symbolsOfText([text]), `${id}/${screen.id}: ${text}`).not.toThrow();
          // A dollar that is left over opened a formula that nothing closed.
          expect(piecesOf(text).some(({ kind, text: part }) => kind === "words" && part.includes("$"))).toBe(
            false,
          );
        }
      }
    }
  });

  it("use every symbol that is defined", () => {
    const used = new Set(
      lessons.flatMap(({ screens }) => screens.flatMap((screen) => symbolsOfText(wordsOf(screen)))),
    );
    const unused = Object.entries(SYMBOLS).filter(([, symbol]) => !used.has(symbol));
    expect(unused.map(([name]) => name)).toEqual([]);
  });

  it("have right answers among their options, and estimates within reach", () => {
    for (const { id, screens } of lessons) {
      for (const { predict, id: screen } of screens) {
        if (predict?.kind === "choice") {
          expect(predict.options[predict.right()], `${id}/${screen}`).toBeDefined();
        }
        if (predict?.kind === "estimate") {
          const { truth, within } = predict;
          const [min, max] = predict.range;
          expect(truth(), `${id}/${screen}`).toBeGreaterThan(min);
          expect(truth(), `${id}/${screen}`).toBeLessThan(max);
          // The slider's first place must not be the answer.
          expect(Math.abs((min + max) / 2 - truth()), `${id}/${screen}`).toBeGreaterThan(within);
        }
      }
    }
  });

  it("say what is true: their claims about the figures hold", () => {
    const whyOf = (lesson: string, screen: string): string => {
      const predict = lessons
        .find(({ id }) => id === lesson)
        ?.screens.find(({ id }) => id === screen)?.predict;
      return predict === undefined ? "" : predict.kind === "place" ? predict.how() : predict.why();
    };
    const saysOf = (lesson: string, screen: string): string =>
      lessons
        .find(({ id }) => id === lesson)
        ?.screens.find(({ id }) => id === screen)
        ?.says?.() ?? "";
    const numbers = (text: string) =>
      (text.match(/−?\d+(\.\d+)?/g) ?? []).map((one) => Number(one.replace("−", "-")));
    // The right window correlates far better than the others.
    const [right = 0, best = 1] = numbers(whyOf("correlation", "which"));
    expect(right).toBeGreaterThan(best + 0.3);
    // Eight views over the same baseline gain about a quarter.
    const [two = 1, eight = 1] = numbers(whyOf("triangulation", "views"));
    expect(eight / two).toBeGreaterThan(0.7);
    expect(eight / two).toBeLessThan(0.8);
    // The slope of the house is where the curve has its peak.
    const degrees = numbers(whyOf("homography", "guess"));
    expect(Math.abs((degrees[2] ?? 0) - 37)).toBeLessThan(4);
    // A near pair has a higher and wider peak than a far one.
    const [near = 0, , nearWidth = 0, far = 1, , farWidth = 1] = numbers(
      saysOf("homography", "baseline").replaceAll("half of it", ""),
    ).flatMap((one, i, all) => (i === 1 || i === 3 ? [0, one] : all[i] !== undefined ? [one] : []));
    expect(near).toBeGreaterThan(far);
    expect(nearWidth).toBeGreaterThan(farWidth);
    // The ends of the two roof sides are said to be accepted, and the starting line is not the best.
    expect(saysOf("homography", "accept")).toContain("accepted");
    expect(saysOf("roofs", "conflict")).toContain("The face stays");
    expect(whyOf("object-space", "describe")).toMatch(/shortest found has \d+ with 4/);
  });
});

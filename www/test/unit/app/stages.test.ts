/** The stages' folders: complete, and with equations that can be read. */
import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";
import { letterOf, linesOf, type MathNode } from "../../../src/app/words/formula";
import { KIND_NAMES } from "../../../src/element/kinds";
import { METHODS } from "../../../src/shared/stages";
import { mainTabOf, stagesOf, tabsOf, tabTitle } from "../../../src/stages/catalogue";
import { FIGURES } from "../../../src/stages/figures";
import { NO_RESULTS, STAGE_FACTS, type Tab } from "../../../src/stages/list";
import { pageOf, STAGE_LAYERS } from "../../../src/stages/pages";

const LESSONS = fileURLToPath(new URL("../../../src/lessons/course", import.meta.url));
const tabs = [...new Set(METHODS.flatMap(tabsOf))];

describe("the stages of the page", () => {
  it("have a figure for each tab, and a tab for each figure", () => {
    expect(Object.keys(FIGURES).sort()).toEqual([...tabs].sort());
    expect(tabs.map(tabTitle)).not.toContain(undefined);
    for (const name of METHODS.flatMap(stagesOf)) {
      expect(tabs).toContain(mainTabOf(name));
    }
  });

  it("begin with slots of their own, and with nothing", () => {
    const slots = Object.values(STAGE_FACTS).flatMap(({ nothing = {} }) => Object.keys(nothing));
    expect(new Set(slots).size).toBe(slots.length);
    const first = Object.values(NO_RESULTS) as (readonly unknown[] | null)[];
    expect(first.every((one) => one === null || one.length === 0)).toBe(true);
  });

  it("show layers that there are, and are empty before they have run", () => {
    for (const tab of tabs) {
      const { shows, isEmpty } = pageOf(tab);
      expect(Object.keys(STAGE_LAYERS)).toEqual(expect.arrayContaining([...(shows ?? [])]));
      expect(isEmpty?.(NO_RESULTS), tab).toBe(shows === undefined ? undefined : true);
    }
    const orders = Object.values(STAGE_LAYERS).flatMap(({ pickOrder }) => pickOrder ?? []);
    expect(new Set(orders).size).toBe(orders.length);
  });

  it("have the figures that lessons show", () => {
    const texts = readdirSync(LESSONS).map((name) => readFileSync(`${LESSONS}/${name}`, "utf8"));
    const shown = texts.flatMap((text) =>
      [...text.matchAll(/realFigure\("([^"]+)"\)/g)].map(([, kind]) => kind),
    );
    expect(shown.length).toBeGreaterThan(3);
    expect(shown.filter((kind) => !KIND_NAMES.includes(kind as string))).toEqual([]);
  });
});

describe("equations of figures", () => {
  const wordsOf = ({ text, children }: MathNode): string[] => [
    ...(text === undefined ? [] : [text]),
    ...children.flatMap(wordsOf),
  ];
  const said = (tab: Tab) => wordsOf(linesOf(FIGURES[tab].equation, letterOf)).join(" ");

  it("can be read", () => {
    for (const tab of tabs) {
      expect(said(tab)).not.toBe("");
    }
    expect(said("dense")).toBe("max l ∑ p N p ( l p ) − β ∑ p , q [ l p ≠ l q ]");
    expect(said("halfplanes")).toBe(
      "H i ( θ ) = A i + a i v T ( θ ) Sim ( θ ) = ∑ i ∫ POI w ( x ) · Cor 2 ( x , H i ( θ ) x )",
    );
  });

  it("have upright vectors, slanted letters and names", () => {
    const [line] = FIGURES.lines.equation;
    expect(line).toContain("vec l");
    expect(letterOf("Sim")?.form).toBe("name");
    expect(letterOf("x′")?.form).toBe("letter");
    expect(letterOf("+x")).toBeNull();
    const node = linesOf(["vec l ^T vec x"], letterOf);
    expect(node.children[1]?.symbol).toMatchObject({ glyph: "x", form: "vector" });
  });
});

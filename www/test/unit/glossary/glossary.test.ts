/** The glossary: every marked term is in it, every term is marked somewhere, and docs/glossary.md is made of it. */
import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { glossaryPage } from "../../../scripts/glossaryPage";
import { partsOf, plain } from "../../../src/app/words/linkedText";
import { TERM_IDS, TERMS, termNamed } from "../../../src/app/words/terms";

const SOURCE = new URL("../../../src/", import.meta.url);
const OWN = /^app\/words\//;

/** The ids that texts name, in marks and in components. */
function named(): Set<string> {
  const files = readdirSync(SOURCE, { recursive: true, encoding: "utf8" })
    .map((file) => file.replaceAll("\\", "/"))
    .filter((file) => /\.tsx?$/.test(file) && !file.startsWith("pkg") && !OWN.test(file));
  const found = files.flatMap((file) => {
    const text = readFileSync(new URL(file, SOURCE), "utf8");
    const marks = [...text.matchAll(/\[\[([a-z][a-z-]*)(?:\||\]\])/g)].map(([, id]) => id ?? "");
    const components = [...text.matchAll(/<Term\s+id="([^"]*)"/g)].map(([, id]) => id ?? "");
    return [...marks, ...components];
  });
  return new Set(found);
}

describe("the glossary", () => {
  it("has every term that a text names", () => {
    expect([...named()].filter((id) => termNamed(id) === null)).toEqual([]);
    expect(named().size).toBeGreaterThan(25);
  });

  it("has no term that is neither named in a text nor explained for another one", () => {
    const reached = named();
    for (const id of reached) {
      for (const other of termNamed(id)?.see ?? []) {
        reached.add(other);
      }
    }
    expect(TERM_IDS.filter((id) => !reached.has(id))).toEqual([]);
  });

  it("leads on to terms that exist, and says each in two sentences", () => {
    for (const id of TERM_IDS) {
      const { see, says, word } = TERMS[id];
      expect(
        see.filter((other) => termNamed(other) === null || other === id),
        id,
      ).toEqual([]);
      expect(says.length, word).toBeGreaterThan(30);
      expect(says, word).toMatch(/\.$/);
    }
    const words = TERM_IDS.map((id) => TERMS[id].word);
    expect(new Set(words).size).toBe(words.length);
    expect(termNamed("constructor")).toBeNull();
  });

  it("is docs/glossary.md (npm run lists)", () => {
    const page = readFileSync(new URL("../../docs/glossary.md", SOURCE), "utf8");
    expect(page).toBe(glossaryPage());
  });
});

describe("a text with terms", () => {
  it("falls into its parts", () => {
    expect(partsOf("A [[ridge]] and two [[hip|hips]].")).toEqual([
      "A ",
      { id: "ridge", words: "ridge" },
      " and two ",
      { id: "hip", words: "hips" },
      ".",
    ]);
    expect(plain("[[epipolar-line|Lines]] x[[0]] [[")).toBe("Lines x[[0]] [[");
    expect(partsOf("")).toEqual([]);
  });
});

/** What people read is plain English of the field, with units and plurals right. */
import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { stringsOf, visibleStrings } from "../visibleStrings";

/** Words that say nothing to a photogrammetrist, and what is said instead. */
const FORBIDDEN: readonly (readonly [RegExp, string])[] = [
  [/\brefus(e|ed|al|es)\b|\bwithdrawn?\b/i, "rejected"],
  [/\bstrengths?\b/i, "saturation, contrast"],
  [/\bfirst view\b/i, "reference view"],
  [/\bfate\b|\bverdict\b/i, "outcome"],
  [/\bbe shown how\b|\bdrop kept\b/i, "a verb: take, discard"],
  [/\bcannot be:|\bleaves one angle\b|\bsays who\b|\btold as\b|\bgrows up to\b/i, "what is meant"],
  [/\blooked at$|\d looked at\b|\} looked at\b/, "evaluated"],
  [/\bphotograph part\b/i, "do not coincide"],
  [/\bin tiles of\b/i, "tile size"],
  [/\bPoi\b/, "interest point"],
  [/\bdefaults are the paper/i, "where a paper states a value"],
  [/\bout of your\b|\byour (mistake|fault)\b|\byou (must|failed|forgot)\b/i, "no blame"],
];

/** A number before a plural: `counted` knows whether it is one. */
const UNCOUNTED =
  /\{\} (?:[a-z-]+ )?(?:views|lines|files|facets|segments|planes|half-planes|warnings|images|tiles|points|buildings|cells|candidates|clusters|regions|relations|sides|photographs)\b/;

/** Of these there are always several. */
const SEVERAL = [/parameters changed/];

/** Code, not words: names of records and options of the core, selectors. */
const isCode = (text: string) => !text.includes(" ") && !/^[A-Z]/.test(text);

describe("the words of the page", () => {
  const shown = visibleStrings().filter(({ text }) => !isCode(text));
  /** A text about two views has a first one, and no reference. */
  const isOfTwo = (at: string, word: RegExp) =>
    at.startsWith("lessons/") && word.source.includes("first view");

  it("are found in tags, attributes and literals", () => {
    const source = `<p title="One two">Be {n} of <b>all</b></p>; const a = \`\${n} lines of \${m}\`;`;
    expect(stringsOf("a.tsx", source).map(({ text }) => text)).toEqual([
      "Be {} of {}",
      "One two",
      "all",
      "{} lines of {}",
    ]);
    expect(shown.length).toBeGreaterThan(400);
    expect(shown.map(({ text }) => text)).toContain("Take the tour");
  });

  it("are those of the field", () => {
    const wrong = shown.flatMap(({ at, text }) =>
      FORBIDDEN.filter(([word]) => word.test(text) && !isOfTwo(at, word)).map(
        ([, better]) => `${at}: "${text}"; say ${better}`,
      ),
    );
    expect(wrong).toEqual([]);
  });

  it("are those of the field in the core's notices and the command line's help", () => {
    const wrong = coreStrings().flatMap(({ at, text }) =>
      FORBIDDEN.filter(([word]) => word.test(text)).map(([, better]) => `${at}: "${text}"; say ${better}`),
    );
    expect(wrong).toEqual([]);
  });

  it("count with the one helper that knows singular and plural", () => {
    const wrong = shown.filter(
      ({ text }) => UNCOUNTED.test(text) && !SEVERAL.some((exempt) => exempt.test(text)),
    );
    expect(wrong).toEqual([]);
  });
});

/** Folders of the core with texts for people; readers say theirs in `orientation` and `scene_loader`. */
const OF_THE_CORE = ["cli", "pipeline", "orienting/orientation_check", "tiles"];
const CORE = new URL("../../../../src/", import.meta.url);

/** String literals with a blank, and what the command line prints of its arguments. */
function coreStrings(): { at: string; text: string }[] {
  return OF_THE_CORE.flatMap((folder) => {
    const names = readdirSync(new URL(`${folder}/`, CORE), { recursive: true, encoding: "utf8" });
    return names
      .filter((name) => name.endsWith(".rs"))
      .flatMap((name) => {
        const [source = ""] = readFileSync(new URL(`${folder}/${name}`, CORE), "utf8").split("#[cfg(test)]");
        const help = name === "args.rs" ? (source.match(/\/\/\/ .*/g) ?? []) : [];
        const code = source.replace(/^\s*\/\/.*$/gm, "");
        const literals = code.match(/"[^"\n]* [^"\n]*"/g) ?? [];
        return [...help, ...literals].map((text) => ({ at: `${folder}/${name}`, text }));
      });
  });
}

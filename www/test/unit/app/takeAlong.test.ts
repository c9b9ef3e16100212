/** What figures say of themselves outside of the page: their state in links, their papers, their numbers. */
import { describe, expect, it } from "vitest";
import { citationOf } from "../../../src/app/results/takeAlong/citation";
import { csvOf, numbered } from "../../../src/app/results/takeAlong/rows";
import {
  addressOf,
  FIRST_STATE,
  type FigureState,
  formatState,
  parseState,
  stateInAddress,
} from "../../../src/element/figureState";
import { fetchScene, sceneUrl } from "../../../src/element/sceneFiles";
import { tabsOf } from "../../../src/stages/catalogue";
import { type Figure, NO_DETAIL } from "../../../src/stages/figure";
import { FIGURES } from "../../../src/stages/figures";
import { NO_RESULTS } from "../../../src/stages/list";

const PAGE = "https://school.example/lesson/3.html?class=a#top";

describe("the state of a figure", () => {
  const STATES: Partial<FigureState>[] = [
    {},
    { select: "segment:2.44", point: [3, 0.125] },
    { select: "side:12.left", theta: -31.5 },
    { select: "cluster:1.7", view: 4, plane: 2 },
  ];

  it.each(STATES)("comes back from its words and from an address: %o", (part) => {
    const state = { ...FIRST_STATE, ...part };
    expect(parseState(formatState(state))).toEqual(state);
    const address = addressOf(PAGE, "sweep", state);
    expect(stateInAddress(new URL(address).hash, "sweep")).toEqual(state);
    expect(stateInAddress(new URL(address).hash, "other")).toBeNull();
    // The rest of the address stays.
    expect(address).toMatch(/^https:\/\/school\.example\/lesson\/3\.html\?class=a#sweep=/);
  });

  it("leaves out what is none", () => {
    const words = "select=line:none&theta=east&point=1,2,3&view=-1&plane=1e9";
    expect(parseState(words)).toEqual(FIRST_STATE);
    expect(parseState("theta=&point=,")).toEqual(FIRST_STATE);
    expect(parseState("select=line:7&theta=1e400")).toEqual({ ...FIRST_STATE, select: "line:7" });
  });
});

describe("the address of a scene", () => {
  it("is the demo's manifest by name, and else relative to the page", () => {
    const demo = "https://cdn.example/ridgeline/dist/demo";
    expect(sceneUrl("demo", demo, PAGE)).toBe(`${demo}/manifest.json`);
    expect(sceneUrl("demo", "./scenes/demo/", PAGE)).toBe(
      "https://school.example/lesson/scenes/demo/manifest.json",
    );
    expect(sceneUrl("my roof.zip", demo, PAGE)).toBe("https://school.example/lesson/my%20roof.zip");
  });

  it("holds one file, or those of a manifest, by their own paths", async () => {
    const served: Record<string, string> = {
      "https://a.example/x/manifest.json": JSON.stringify({ files: ["images/1.jpg", "cameras.json"] }),
      "https://a.example/x/images/1.jpg": "one",
      "https://a.example/x/cameras.json": "{}",
      "https://a.example/my%20roof.zip": "PK",
    };
    const before = globalThis.fetch;
    globalThis.fetch = async (url) => {
      const body = served[String(url)];
      return new Response(body ?? "", { status: body === undefined ? 404 : 200 });
    };
    try {
      const paths = async (url: string) => (await fetchScene(url)).map(({ path }) => path);
      expect(await paths("https://a.example/x/manifest.json")).toEqual(["images/1.jpg", "cameras.json"]);
      expect(await paths("https://a.example/my%20roof.zip")).toEqual(["my roof.zip"]);
      await expect(paths("https://a.example/x/cameras.json")).rejects.toThrow(/manifest names the files/);
      await expect(paths("https://a.example/none")).rejects.toThrow(/404/);
    } finally {
      globalThis.fetch = before;
    }
  });
});

describe("whom to cite", () => {
  it.each(tabsOf("combined"))("is said of %s with its section", (tab) => {
    const cited = citationOf(FIGURES[tab]);
    const entries = [...cited.matchAll(/^@inproceedings\{(\w+),$/gm)].map(([, key]) => key);
    expect(entries.length).toBeGreaterThan(0);
    expect(new Set(entries).size).toBe(entries.length);
    expect(cited.match(/note += \{Section \d/g)).toHaveLength(entries.length);
    // As BibTeX reads it: braces close.
    expect(cited.split("{").length).toBe(cited.split("}").length);
  });

  it("names both papers where both have it", () => {
    expect(citationOf(FIGURES.images)).toMatch(
      /Baillard1999[\s\S]*Section 2, figure 1[\s\S]*Wiman1996[\s\S]*3\.2/,
    );
  });
});

describe("the numbers behind a figure", () => {
  it("are quoted where they must be (RFC 4180)", () => {
    const rows = [
      { name: 'a "b", c', value: 0.5 },
      { name: "d", value: null, more: true },
    ];
    expect(csvOf(rows)).toBe('name,value,more\r\n"a ""b"", c",0.5,\r\nd,,true\r\n');
  });

  it("name things by numbers that count from 1, as the page and the files do", () => {
    expect(numbered([{ facet: 0, corner: 3, corners: 4, view: "a.jpg", match: null }])).toEqual([
      { facet: 1, corner: 4, corners: 4, view: "a.jpg", match: null },
    ]);
  });

  it("are none where nothing was found", () => {
    const empty = {
      scene: null,
      images: [],
      results: NO_RESULTS,
      params: {},
      selection: null,
      detail: NO_DETAIL,
      view: 0,
      plane: 0,
      inText: true,
    } as unknown as Figure;
    for (const { rows } of Object.values(FIGURES)) {
      expect(rows(empty)).toEqual([]);
    }
  });

  it("have the angle in degrees, and a column a view", () => {
    const curve = {
      thetas: [0, Math.PI / 6],
      similarity: [0.2, 0.8],
      views: [{ view: 1, similarity: [0.1, 0.9] }],
    };
    const figure = {
      scene: { views: [{ name: "a.jpg" }, { name: "b.jpg" }] },
      detail: { ...NO_DETAIL, side: { curve } },
    } as unknown as Figure;
    const [, second] = FIGURES.halfplanes.rows(figure);
    expect(second).toMatchObject({ sim: 0.8, "sim_b.jpg": 0.9 });
    expect(second?.["theta_deg"]).toBeCloseTo(30, 9);
  });
});

import { readdirSync, readFileSync } from "node:fs";
import { basename, dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";

const SOURCES = fileURLToPath(new URL("../../src", import.meta.url));

/** What is known of the things that can be picked. */
const KINDS = ["kinds/parts", "kinds/images", "kinds/lines", "kinds/planes", "kinds/roofs", "kinds"];

/** The rooms from the ground up, each with those that it may import from besides itself. */
const ROOMS: Readonly<Record<string, readonly string[]>> = {
  shared: [],
  worker: ["shared"],
  core: ["shared"],
  package: ["shared"],
  "viewer/scene": ["shared"],
  "viewer/layers": ["shared", "viewer/scene"],
  "viewer/tools": ["shared", "viewer/scene"],
  viewer: ["shared", "viewer/scene", "viewer/layers", "viewer/tools"],
  stages: ["shared"],
  ...floors(
    ["shared", "core", "viewer/scene", "viewer/layers", "viewer/tools", "viewer", "stages"],
    [
      "app/state",
      "app/view/screen",
      "app/parts",
      ...KINDS,
      "app/words",
      "app/settings",
      "app/project/tiles",
      "app/session",
      "app/project",
      "app/project/flight",
      "app/project/orienting/plans",
      "app/project/orienting",
      "app/project/photographs",
      "app/selection",
      "app/inspector",
      "app/project/known",
      "app/results/corrections",
      "app/results/comparison",
      "app/view/images",
      "app/view/figures",
      "app/results/takeAlong",
      "stages/figures",
      "stages/pages",
      "app/view/space",
      "stages/tours",
      "app/tour",
      "app/view/stages",
      "app/view/result",
      "app/project/entrance",
      "app/shell",
    ],
  ),
  ...floors(
    [
      "shared",
      "core",
      "stages",
      "app/state",
      "app/parts",
      ...KINDS,
      "app/words",
      "app/selection",
      "app/view/images",
      "app/view/figures",
      "app/results/takeAlong",
      "stages/figures",
    ],
    ["element"],
  ),
  ...floors(
    [
      "shared",
      "core",
      "stages",
      "app/state",
      "app/words",
      "app/parts",
      "app/settings",
      "app/project",
      "element",
    ],
    ["lessons/toy", "lessons/parts", "lessons/scene", "lessons/course", "lessons"],
  ),
  ...floors(
    ["shared", "core", "stages", "app/state", "app/parts", "app/words", "element"],
    [
      "exercise/judging",
      "exercise/functions",
      "exercise/numbers",
      "exercise/figures",
      "exercise/views",
      "exercise",
      "exercise/page",
    ],
  ),
};

/** What the package's exports and workers start from. */
const PACKAGE_ENTRIES = [
  ...["browser", "browserWorker", "node", "nodeWorker"].map((name) => `package/${name}.ts`),
  ...["figure", "anywidget"].map((name) => `element/${name}.ts`),
  "exercise/exercise.ts",
];

/** So many files are found at a glance. */
const MOST_FILES = 15;

/** Each of `names` may import from `base` and from those before it. */
function floors(base: readonly string[], names: readonly string[]): Record<string, readonly string[]> {
  return Object.fromEntries(names.map((name, i) => [name, [...base, ...names.slice(0, i)]]));
}

/** What the build makes, and no room of the house. */
const BUILT = ["pkg/", "pkg-orient/"];

const files = readdirSync(SOURCES, { recursive: true, withFileTypes: true })
  .filter((entry) => entry.isFile())
  .map((entry) => relative(SOURCES, join(entry.parentPath, entry.name)))
  .filter((path) => !BUILT.some((folder) => path.startsWith(folder)))
  .sort();
const modules = files.filter((path) => /\.tsx?$/.test(path));

/** Every file with the files of this source tree that it imports. */
const imports = new Map(modules.map((path) => [path, importsOf(path)]));

function importsOf(path: string): string[] {
  const text = readFileSync(join(SOURCES, path), "utf8");
  const named = [...text.matchAll(/(?:^import|^export|^\}|\bimport\() ?[^;"]*"(\.[^"]+)"/gm)]
    .map(([, named]) => join(dirname(path), named as string))
    .flatMap((named) => {
      const found = [named, `${named}.ts`, `${named}.tsx`, named.replace(/\.js$/, ".ts")].find((one) =>
        files.includes(one),
      );
      return found === undefined ? [] : [found];
    });
  return [...named, ...globbed(path, text)];
}

/** The files that a module imports by a pattern. */
function globbed(path: string, text: string): string[] {
  const [, pattern] = /import\.meta\.glob[^"]*"(\.[^"]+)"/.exec(text) ?? [];
  if (pattern === undefined) {
    return [];
  }
  const words: Record<string, string> = { ".": "\\.", "*": "[^/]+", "{": "(", ",": "|", "}": ")" };
  const wanted = new RegExp(
    `^${join(dirname(path), pattern).replace(/[.*{,}]/g, (sign) => words[sign] ?? "")}$`,
  );
  return files.filter((file) => wanted.test(file));
}

/** A stage's folder is on four floors: what is known of it, what is drawn of it anywhere, what only the page has, the tour. */
function roomOf(path: string): string {
  if (!path.startsWith("stages/")) {
    return dirname(path);
  }
  const name = basename(path);
  if (/^(tour|tourStep)\.ts$/.test(name)) {
    return "stages/tours";
  }
  const isOfPage = /^(page|pages|stagePage|sample|PageLegend|ModelModes)\.|Layer\.ts$/.test(name);
  return /^(stage|list|catalogue|figure)\.ts$/.test(name)
    ? "stages"
    : isOfPage
      ? "stages/pages"
      : "stages/figures";
}

/** Files that import each other, directly or over others: each circle by the way round it. */
function circles(graph: ReadonlyMap<string, readonly string[]>): string[] {
  const found: string[] = [];
  const done = new Set<string>();
  const visit = (path: string, way: readonly string[]) => {
    const start = way.indexOf(path);
    if (start >= 0) {
      found.push([...way.slice(start), path].join(" > "));
      return;
    }
    if (!done.has(path)) {
      for (const next of graph.get(path) ?? []) {
        visit(next, [...way, path]);
      }
      done.add(path);
    }
  };
  for (const path of graph.keys()) {
    visit(path, []);
  }
  return found;
}

describe("the rooms of the page", () => {
  it("are all in the table, and none is crowded", () => {
    const counts = new Map<string, number>();
    for (const path of files) {
      counts.set(dirname(path), (counts.get(dirname(path)) ?? 0) + 1);
    }
    expect([...new Set(files.map(roomOf))].sort()).toEqual(Object.keys(ROOMS).sort());
    expect([...counts].filter(([, count]) => count > MOST_FILES)).toEqual([]);
  });

  it("import only from those below them", () => {
    const climbing = [...imports].flatMap(([path, named]) =>
      named
        .filter((one) => roomOf(one) !== roomOf(path) && !ROOMS[roomOf(path)]?.includes(roomOf(one)))
        .map((one) => `${path} > ${one}`),
    );
    expect(climbing).toEqual([]);
  });

  it("have no circle of files", () => {
    expect(circles(imports)).toEqual([]);
    expect(
      circles(
        new Map([
          ["a", ["b"]],
          ["b", ["c"]],
          ["c", ["b"]],
        ]),
      ),
    ).toEqual(["b > c > b"]);
  });

  it("are all lived in: the first files of page and package reach every module but the worker's", () => {
    const reached = new Set<string>();
    const walk = (path: string) => {
      if (!reached.has(path)) {
        reached.add(path);
        imports.get(path)?.forEach(walk);
      }
    };
    const entries = ["app/shell/main.tsx", "lessons/main.tsx", "exercise/page/exercises.tsx"];
    for (const entry of [...entries, ...PACKAGE_ENTRIES]) walk(entry);
    const beyond = modules.filter((path) => !reached.has(path) && !path.startsWith("worker/"));
    expect(beyond).toEqual([]);
  });
});

describe("figures in other pages", () => {
  it("hold nothing of the page's state but the size of text and how it is kept, and nothing that draws space", () => {
    const reached = new Set<string>();
    const walk = (path: string) => {
      if (!reached.has(path)) {
        reached.add(path);
        const text = readFileSync(join(SOURCES, path), "utf8");
        imports
          .get(path)
          ?.filter((named) => isRunning(text, basename(named)))
          .forEach(walk);
      }
    };
    walk("element/figure.ts");
    expect(reached).toContain("stages/halfplanes/SimLab.tsx");
    const held = [...reached].filter((path) =>
      /^app\/(state|session|project|view\/space|shell)\//.test(path),
    );
    expect(held).toEqual(["app/state/textScale.ts", "app/state/keptChoice.ts"]);
    const drawing = [...reached].filter((path) =>
      /from "three"/.test(readFileSync(join(SOURCES, path), "utf8")),
    );
    expect(drawing).toEqual([]);
  });
});

/** Whether a module of this name is imported for more than its types. */
function isRunning(text: string, file: string): boolean {
  const name = file.replace(/\.tsx?$/, "");
  const all = [...text.matchAll(/^(?:import|export) (type )?[^;]*"\.[^"]*\/(\w+)"/gm)];
  const isImported = all.some(([, isType, named]) => named === name && isType === undefined);
  return isImported || text.includes("import.meta.glob");
}

describe("the page's state", () => {
  it("can be written only by the module that holds it", () => {
    const writable = modules.filter((path) =>
      /^export (?:const|let) \w+(?:: Signal\b[^=]*)? = signal\b/m.test(
        readFileSync(join(SOURCES, path), "utf8"),
      ),
    );
    expect(writable).toEqual([]);
  });
});

/**
 * docs/figures.md: each figure of the papers, and the live figure that shows it on the demo scene; and docs/model.png. Figures that
 * stand by themselves (`kind`) are their own SVG exports; views in space, and of the whole page, are pictures of the built site.
 * Writes the page. `npm run build && npm run figures`
 */
import { mkdirSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { withExports } from "./exports.mjs";
import { withSite } from "./site.mjs";

const DOCS = new URL("../../docs/", import.meta.url);
const PORT = Number(process.env.PORT ?? 4179);
const SITE = `http://127.0.0.1:${PORT}/`;
const QUALITY = 74;

const tab = (name) => async (page) =>
  page
    .getByRole("tab")
    .filter({ has: page.locator("b").getByText(name, { exact: true }) })
    .click();
const button = (name) => async (page) => page.getByRole("button", { name, exact: true }).click();
const allViews = async (page) =>
  page.getByRole("group", { name: "View" }).getByRole("button", { name: "All" }).click();

/** Opens a link of the page itself, whose address holds the state of a view, and waits for the stage that it needs. */
const link = (fields, stage) => async (page) => {
  // Anew: in an open page the link would only change what that page shows.
  await page.goto("about:blank");
  await page.goto(`${SITE}#scene=demo&face=method&${fields}`);
  const isDone = (name) => document.querySelector(`[data-stage="${name}"]`)?.dataset.status === "done";
  await page.waitForFunction(isDone, stage, { timeout: 120_000 });
  await page.waitForTimeout(1000);
};

/** Sections of the page: pictures, what the papers' figures show, and the kind of figure or how to get there on the page. */
const B99 = [
  {
    name: "segments",
    figures: "3.2",
    shows: "line segments of a view",
    kind: "segments",
  },
  {
    name: "beam",
    figures: "1, 2 and 4",
    shows: "the epipolar beam of a segment, its candidates, and the windows at corresponding points",
    kind: "epipolar-beam",
  },
  {
    name: "transfer",
    figures: "3",
    shows: "the line that a pair of segments predicts in a third view",
    kind: "point-transfer",
  },
  {
    name: "matches",
    figures: "5 and 6",
    shows: "matched, merged and grown parts over all views",
    steps: [link("tab=matches", "matches"), allViews],
  },
  {
    name: "before",
    figures: "5 and 7",
    shows: "3D lines before merging and growing",
    steps: [link("tab=lines", "lines"), button("Before growing")],
  },
  {
    name: "lines",
    figures: "6 and 8",
    shows: "3D lines after it",
    steps: [link("tab=lines", "lines")],
  },
  {
    name: "accuracy",
    figures: "9",
    shows: "accuracy against the number of views, and the picked line in every view",
    kind: "line-accuracy",
  },
  {
    name: "halfplane",
    figures: "10 to 14",
    shows:
      "the homography of a half-plane: points of interest, warped windows, Sim(theta) in total and per view",
    kind: "theta-sweep",
  },
  {
    name: "fans",
    figures: "15",
    shows: "accepted half-planes as fans, rejected sides as thin red lines",
    steps: [link("tab=halfplanes", "halfplanes")],
  },
  {
    name: "groups",
    figures: "16 to 20",
    shows: "collinear and coplanar grouping: the groups, and the lines of one in every view",
    kind: "groups",
  },
  {
    name: "facets",
    figures: "21 to 23",
    shows: "border lines by their kind, closed outlines, facets and what was rejected",
    kind: "facet-plan",
  },
  {
    name: "refinement",
    figures: "2",
    shows: "a building before and after refinement, and the relations that were tested by their chi-square",
    kind: "refinement",
  },
  {
    name: "new-lines",
    figures: "17 to 20",
    shows: "new lines of the model beside the matched ones: intersections of planes, and borders seen again",
    steps: [link("tab=model", "model"), tab("3D lines"), button("After")],
  },
  {
    name: "model",
    figures: "24 and 25",
    shows: "the textured model",
    steps: [tab("Model")],
  },
  {
    name: "photograph",
    figures: "–",
    shows: "the model under the photograph of a view, seen by its camera",
    steps: [async (page) => page.getByLabel("Look through the camera of a view").selectOption("2")],
  },
];
const W96 = [
  {
    name: "regions",
    figures: "3",
    shows: "regions with straight shared boundaries",
    kind: "regions",
  },
  {
    name: "directions",
    figures: "4 and 5",
    shows: "main directions: the histogram of azimuths and its two perpendicular peaks",
    kind: "main-directions",
  },
  {
    name: "clusters",
    figures: "6 to 8",
    shows: "the cluster plane with the image lines of all views, the selected clusters and the rejected ones",
    kind: "clusters",
  },
  {
    name: "rectangles",
    figures: "10 to 12",
    shows: "the window between two parallel lines, the histogram of positions, and the selected planes",
    kind: "rectangles",
  },
];

const fileOf = ({ name, kind }, prefix) => `${prefix}-${name}.${kind === undefined ? "jpg" : "svg"}`;

async function exportsOf(exportFigure, sections, prefix) {
  for (const section of sections.filter(({ kind }) => kind !== undefined)) {
    const svg = await exportFigure({ kind: section.kind });
    writeFileSync(new URL(`figures/${fileOf(section, prefix)}`, DOCS), svg);
    process.stdout.write(`${fileOf(section, prefix)}\n`);
  }
}

async function picturesOf(page, sections, prefix) {
  for (const section of sections.filter(({ kind }) => kind === undefined)) {
    for (const step of section.steps) {
      await step(page);
    }
    await page.waitForTimeout(900);
    const path = new URL(`figures/${fileOf(section, prefix)}`, DOCS).pathname;
    await page.locator(".stage-view").screenshot({ path, type: "jpeg", quality: QUALITY });
    process.stdout.write(`${fileOf(section, prefix)}\n`);
  }
}

/** "figures 1 to 4", "section 3.2". */
function where(figures) {
  if (figures === "–") {
    return "(no figure)";
  }
  const isSection = figures.includes(".") || figures === "2";
  return isSection ? `section ${figures}` : `figure${figures.length > 2 ? "s" : ""} ${figures}`;
}

function table(sections, prefix, paper) {
  const sectionOf = (section) => {
    const { figures, shows, kind } = section;
    const own = kind === undefined ? "" : ` \`<ridgeline-figure kind="${kind}">\``;
    const title = `${paper} ${where(figures)}`;
    const sentence = `${shows[0].toUpperCase()}${shows.slice(1)}.${own}`;
    return `### ${title}\n\n${sentence}\n\n![${shows}](figures/${fileOf(section, prefix)})\n`;
  };
  return sections.map(sectionOf).join("\n");
}

await withSite(PORT, async (browser) => {
  const folder = new URL("figures/", DOCS);
  mkdirSync(folder, { recursive: true });
  for (const old of readdirSync(folder).filter((name) => /^(b99|w96)-/.test(name))) {
    rmSync(new URL(old, folder));
  }
  await withExports(browser, async (exportFigure) => {
    await exportsOf(exportFigure, B99, "b99");
    await exportsOf(exportFigure, W96, "w96");
  });
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  await link("tab=model", "model")(page);
  await button("Result")(page);
  await page.waitForTimeout(3000);
  await page.screenshot({ path: new URL("model.png", DOCS).pathname });
  await page.setViewportSize({ width: 1280, height: 860 });
  await picturesOf(page, B99, "b99");
  await picturesOf(page, W96, "w96");
  const text = `# The figures of the papers, live

Each view of the page draws what the papers draw, from the demo scene and from any other. Where a figure stands by itself, the
picture is its own SVG export, as "Take along" saves it; views in space are pictures of the page. All are made by
\`npm run figures\` (in www/, after \`npm run build\`).

## B99: Baillard, Schmid, Zisserman, Fitzgibbon 1999

${table(B99, "b99", "B99")}
## W96: Wiman, Axelsson 1996

${table(W96, "w96", "W96")}`;
  writeFileSync(new URL("figures.md", DOCS), text);
});

/**
 * docs/figures.md: each figure of the papers, and the live view that shows it on the demo scene; and docs/model.png. Opens the
 * built site in Chromium, takes the pictures and writes the page. `npm run build && npm run figures`
 */
import { mkdirSync, writeFileSync } from "node:fs";
import { withSite } from "./site.mjs";

const DOCS = new URL("../../docs/", import.meta.url);
const PORT = Number(process.env.PORT ?? 4179);
const SITE = `http://127.0.0.1:${PORT}/`;
const QUALITY = 74;

const tab = (name) => async (page) => page.getByRole("tab", { name, exact: true }).click();
const button = (name) => async (page) => page.getByRole("button", { name, exact: true }).click();
const allViews = async (page) =>
  page.getByRole("group", { name: "View" }).getByRole("button", { name: "All" }).click();
const firstView = async (page) =>
  page.getByRole("group", { name: "View" }).getByRole("button", { name: /_01/ }).first().click();

/** Picks segments until one has several candidates. */
async function pickSegment(page) {
  await firstView(page);
  const image = page.locator(".image-view canvas").first();
  const box = await image.boundingBox();
  for (let i = 0; i < 100 && (await page.locator(".candidates tbody tr").count()) < 4; i += 1) {
    const x = box.width * (0.25 + 0.055 * (i % 10));
    const y = box.height * (0.2 + 0.07 * Math.floor(i / 10));
    await image.click({ position: { x, y } });
    await page.waitForTimeout(80);
  }
  await allViews(page);
}

/** A half-plane of a facet: one of a roof, not of the street. */
async function pickHalfPlane(page) {
  const facets = page.locator(".plan-facet");
  const row = page.getByTestId("inspector").locator("div", { hasText: /^Half-planes/ });
  for (let i = 0; i < (await facets.count()) && (await row.count()) === 0; i += 1) {
    await facets.nth(i).press("Enter");
    await page.waitForTimeout(200);
  }
  await row.getByRole("button").first().click();
}

/** Opens a link of the page itself, whose address holds the state of a view, and waits for the stage that it needs. */
const link = (fields, stage) => async (page) => {
  // Anew: in an open page the link would only change what that page shows.
  await page.goto("about:blank");
  await page.goto(`${SITE}#scene=demo&${fields}`);
  const isDone = (name) => document.querySelector(`[data-stage="${name}"]`)?.dataset.status === "done";
  await page.waitForFunction(isDone, stage, { timeout: 120_000 });
  await page.waitForTimeout(1000);
};

/** Sections of the page: pictures, what the papers' figures show, and how to get there. */
const B99 = [
  {
    name: "segments",
    figures: "3.2",
    shows: "line segments of a view, and what was rejected",
    steps: [tab("Segments"), firstView, button("Rejected lines")],
  },
  {
    name: "beam",
    figures: "1 to 4",
    shows:
      "the epipolar beam of a segment, point-wise correspondence, the reprojected line and its distance in third views",
    steps: [tab("Matches"), pickSegment],
  },
  {
    name: "matches",
    figures: "5 and 6",
    shows: "matched, merged and grown parts over all views",
    steps: [button("Clear"), tab("Matches"), allViews],
  },
  {
    name: "before",
    figures: "5 and 7",
    shows: "3D lines before merging and growing",
    steps: [tab("3D lines"), button("Before growing")],
  },
  {
    name: "lines",
    figures: "6, 8 and 9",
    shows: "3D lines after it; accuracy against the number of views; the picked line in every view",
    steps: [link("tab=lines&select=line:7", "lines")],
  },
  {
    name: "halfplane",
    figures: "10 to 14",
    shows:
      "the homography of a half-plane: points of interest, warped windows, Sim(theta) in total and per view",
    steps: [link("tab=facets", "facets"), pickHalfPlane, tab("Half-planes")],
  },
  {
    name: "fans",
    figures: "15",
    shows: "accepted half-planes as fans, rejected sides as thin red lines",
    steps: [button("Clear")],
  },
  {
    name: "groups",
    figures: "16 to 20",
    shows: "collinear and coplanar grouping, and new lines in the planes",
    steps: [
      link("tab=model", "model"),
      tab("Groups"),
      async (page) => page.getByTestId("groups").getByRole("button").first().click(),
    ],
  },
  {
    name: "facets",
    figures: "21 to 23",
    shows: "border lines by their kind, closed outlines, facets and what was rejected",
    steps: [tab("Facets"), async (page) => page.locator(".plan-facet").nth(3).press("Enter")],
  },
  {
    name: "refinement",
    figures: "2",
    shows: "a building before and after refinement, and the relations that were tested by their chi-square",
    steps: [
      button("Clear"),
      tab("Refinement"),
      async (page) => page.locator(".relation").first().press("Enter"),
    ],
  },
  {
    name: "new-lines",
    figures: "17 to 20",
    shows: "new lines of the model beside the matched ones: intersections of planes, and borders seen again",
    steps: [button("Clear"), tab("3D lines"), button("After")],
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
    steps: [link("method=rectangles&tab=model", "model"), tab("Regions"), firstView],
  },
  {
    name: "directions",
    figures: "4 and 5",
    shows: "main directions: the histogram of azimuths and its two perpendicular peaks",
    steps: [tab("Directions")],
  },
  {
    name: "clusters",
    figures: "6 to 9",
    shows: "the cluster plane with the selected clusters, and a line projected back into all views",
    steps: [
      tab("Clusters"),
      allViews,
      async (page) => page.locator(".cluster").first().click({ force: true }),
    ],
  },
  {
    name: "rectangles",
    figures: "10 to 12",
    shows: "the window between two parallel lines, the histogram of positions, and the selected planes",
    steps: [button("Clear"), tab("Rectangles")],
  },
];

async function picturesOf(page, sections, prefix) {
  for (const { name, steps } of sections) {
    for (const step of steps) {
      await step(page);
    }
    await page.waitForTimeout(900);
    const path = new URL(`figures/${prefix}-${name}.jpg`, DOCS).pathname;
    await page.locator(".stage-view").screenshot({ path, type: "jpeg", quality: QUALITY });
    process.stdout.write(`${prefix}-${name}.jpg\n`);
  }
}

function table(sections, prefix, paper) {
  return sections
    .map(
      ({ name, figures, shows }) =>
        `### ${paper} ${figures === "–" ? "(no figure)" : figures.includes(".") || figures === "2" ? `section ${figures}` : `figure${figures.length > 2 ? "s" : ""} ${figures}`}\n\n${shows[0].toUpperCase()}${shows.slice(1)}.\n\n![${shows}](figures/${prefix}-${name}.jpg)\n`,
    )
    .join("\n");
}

await withSite(PORT, async (browser) => {
  mkdirSync(new URL("figures/", DOCS), { recursive: true });
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  await link("tab=model", "model")(page);
  await page.waitForTimeout(3000);
  await page.screenshot({ path: new URL("model.png", DOCS).pathname });
  await page.setViewportSize({ width: 1280, height: 860 });
  await picturesOf(page, B99, "b99");
  await picturesOf(page, W96, "w96");
  const text = `# The figures of the papers, live

Each view of the page draws what the papers draw, from the demo scene and from any other. The pictures are taken from the
page itself by \`npm run figures\` (in www/, after \`npm run build\`).

## B99: Baillard, Schmid, Zisserman, Fitzgibbon 1999

${table(B99, "b99", "B99")}
## W96: Wiman, Axelsson 1996

${table(W96, "w96", "W96")}`;
  writeFileSync(new URL("figures.md", DOCS), text);
});

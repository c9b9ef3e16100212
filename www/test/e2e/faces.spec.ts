/** The two faces of the page: the model has most of the window at every size, and nothing pushes it. */
import { expect, type Page, test } from "@playwright/test";
import { axeFindings, give, houseFiles, onePage, runButton, save, showFace, waitForStage } from "./helpers";

/** CSS pixels: phone, tablet, laptops, projector; 1920 x 1080 at 200 % and at 400 % zoom. */
const SIZES = [
  [360, 740],
  [768, 1024],
  [1024, 768],
  [1280, 720],
  [1366, 650],
  [1440, 900],
  [1920, 1080],
  [960, 540],
  [480, 270],
] as const;

const LEAST_SHARE = 0.6;

/** The share of the window in which nothing but the 3D view is seen. */
function shareOf(page: Page): Promise<number> {
  return page.evaluate(() => {
    const STEP = 6;
    let [seen, all] = [0, 0];
    for (let y = STEP / 2; y < window.innerHeight; y += STEP) {
      for (let x = STEP / 2; x < window.innerWidth; x += STEP) {
        const top = document.elementFromPoint(x, y);
        seen += top?.getAttribute("data-testid") === "viewer" ? 1 : 0;
        all += 1;
      }
    }
    return seen / all;
  });
}

const boxOf = (page: Page) => page.getByTestId("viewer").boundingBox();

let page: Page;

onePage(async (opened) => {
  page = opened;
  await give(page, houseFiles());
  await expect(page).toHaveURL(/face=result/);
  await runButton(page).click();
  await waitForStage(page, "model");
  await expect(page.getByTestId("buildings")).toContainText("1 building");
});

test("the model fills the window at every size, zoom and type, and what is selected does not push it", async () => {
  const larger = page.getByRole("button", { name: /^Text size/ });
  const shares: string[] = [];
  for (const type of [1, 1.5]) {
    // Larger type is hardest where there is least room.
    for (const [width, height] of type === 1 ? SIZES : SIZES.filter(([across]) => across < 1000)) {
      await page.setViewportSize({ width, height });
      const size = `${width} x ${height}, type ${type}`;
      let share = 0;
      await expect
        .poll(async () => {
          share = await shareOf(page);
          return share;
        }, size)
        .toBeGreaterThan(LEAST_SHARE);
      shares.push(`${size}: ${(100 * share).toFixed(0)} %`);
      const before = await boxOf(page);
      await page.evaluate(() => {
        location.hash = `${location.hash.replace(/&select=[^&]*/, "")}&select=facet:0`;
      });
      await expect(page.getByTestId("inspector")).toContainText("Facet 1");
      await expect.poll(() => boxOf(page), size).toEqual(before);
      await page.getByRole("button", { name: "Clear" }).click();
    }
    await page.setViewportSize({ width: 1920, height: 1080 });
    for (let i = 0; i < 3; i += 1) {
      await larger.click();
    }
  }
  test.info().annotations.push({ type: "share of the 3D view", description: shares.join("; ") });
});

test("a building leads to its facets, the report is read in the page, and saved", async () => {
  await page.setViewportSize({ width: 1280, height: 800 });
  const buildings = page.getByTestId("buildings");
  await buildings.getByRole("button", { name: /^Building 1/ }).click();
  const facets = buildings.getByRole("button", { name: /^Facet \d+/ });
  await expect(facets.first()).toHaveAttribute("aria-pressed", "true");
  await facets.nth(1).click();
  await expect(page.getByTestId("inspector")).toContainText(/Facet \d+/);
  expect(await axeFindings(page)).toEqual([]);
  await page.getByRole("button", { name: "Report", exact: true }).click();
  const report = page.getByRole("dialog", { name: "Roof report" });
  await expect(report.getByRole("heading", { name: "Roof report" })).toBeVisible();
  // Its own style holds: a table as broad as the page.
  await expect(report.locator("table").first()).toHaveCSS("border-collapse", "collapse");
  const buffer = Buffer.from('{"name":"own","setbacks_m":{"eave":0.5}}');
  await report
    .getByLabel("Own setbacks")
    .setInputFiles({ name: "own.json", mimeType: "application/json", buffer });
  await expect(report.getByRole("columnheader", { name: "own, m²" }).first()).toBeVisible();
  await report.getByLabel("Feet").check();
  await expect(report.getByRole("columnheader", { name: "own, ft²" }).first()).toBeVisible();
  await report.getByRole("button", { name: "Close" }).click();
  await expect(report).toHaveCount(0);
  expect((await save(page, "roof_report.html")).toString()).toContain("<h1>Roof report</h1>");
  const { setbacks } = JSON.parse((await save(page, "roofs.json")).toString());
  expect(setbacks.at(-1).name).toBe("own");
  await page.getByRole("button", { name: "Clear" }).click();
});

test("where there is no room beside the model, its buildings lie over it when asked for", async () => {
  await page.setViewportSize({ width: 360, height: 740 });
  await expect(page.getByTestId("buildings")).toBeHidden();
  await page.getByRole("button", { name: "Buildings", exact: true }).click();
  await expect(page.getByTestId("buildings")).toContainText("1 building");
  expect(await axeFindings(page)).toEqual([]);
  await page.getByRole("button", { name: "Close the panel" }).click();
  await expect(page.getByTestId("buildings")).toBeHidden();
});

test("the face is in the address, and stays over visits", async () => {
  await showFace(page, "Method");
  await expect(page).toHaveURL(/face=method/);
  await page.waitForTimeout(600);
  await page.goto("about:blank");
  await page.goto("/");
  await expect(page.getByRole("tablist", { name: "Stage views" })).toBeVisible();
  await page.goBack();
  await page.goto("/#face=result");
  await expect(page.getByRole("tablist", { name: "Stage views" })).toBeHidden();
});

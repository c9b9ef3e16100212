/** Own files in every format of docs/formats.md are read, and become the same model: all say the same of one house. */
import { expect, type Page, test } from "@playwright/test";
import {
  give,
  HOUSE_FORMATS,
  houseFiles,
  lookOf,
  runButton,
  showProject,
  stage,
  visualSfmFiles,
  waitForStage,
  watch,
} from "./helpers";

/** What the stages found, in words and numbers, without their times. */
async function found(page: Page): Promise<string> {
  const of = async (name: string) => (await stage(page, name).locator(".counts").getAttribute("title")) ?? "";
  return `${await of("lines")}; ${await of("refinement")}`;
}

async function reconstruct(page: Page, format: string): Promise<string> {
  await page.goto("/");
  await give(page, houseFiles(format));
  await expect(page.locator(".view .status.good")).toHaveCount(6);
  await runButton(page).click();
  await waitForStage(page, "model");
  await expect(page.getByRole("alert")).toHaveCount(0);
  return found(page);
}

let expected = "";

test.beforeAll(async ({ browser }) => {
  const page = await browser.newPage();
  expected = await reconstruct(page, "krc");
  await page.close();
});

/** Text, XML and binary; what the readers make of the others is compared natively (tests/input/readers.rs). */
const MODELLED = HOUSE_FORMATS.filter((format) => /^(photogrammetric|metashape|colmap_binary)$/.test(format));

for (const format of MODELLED) {
  test(`files of the format ${format} become the same model`, async ({ page }) => {
    const { problems } = watch(page);
    expect(await reconstruct(page, format)).toBe(expected);
    await expect(stage(page, "facets")).toContainText(/[3-9] facets/);
    expect(problems).toEqual([]);
  });
}

test("files of every format are oriented", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  for (const format of HOUSE_FORMATS) {
    await give(page, houseFiles(format));
    await expect(page.locator(".view .status.good"), format).toHaveCount(6);
    await showProject(page);
    await page.getByRole("button", { name: "New project" }).click();
    await expect(page.locator(".view")).toHaveCount(0);
  }
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(problems).toEqual([]);
});

test("the model of own files is drawn", async ({ page }) => {
  await reconstruct(page, "colmap");
  await expect(async () => {
    expect((await lookOf(page, page.getByTestId("viewer"))).drawn).toBeGreaterThan(0.02);
  }).toPass({ timeout: 20_000 });
});

// The format knows no principal point, and the samples are crops: they can be read, but no model comes of them.
test("files of VisualSFM are read", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, visualSfmFiles());
  // Read, and not called good: the images contradict it.
  await expect(page.getByText("orientation read, not used")).toHaveCount(6);
  await expect(page.locator(".view .status").first()).toHaveAttribute("title", /^model\.nvm, line \d+$/);
  expect(problems).toEqual([]);
});

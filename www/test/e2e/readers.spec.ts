/** Own files in every format of docs/formats.md are read: all say the same of one house. */
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
  await give(page, houseFiles(format));
  await expect(page.locator(".view .status.good")).toHaveCount(6);
  await runButton(page).click();
  await waitForStage(page, "model");
  await expect(page.getByRole("alert")).toHaveCount(0);
  return found(page);
}

// What the readers make of all formats is compared natively (tests/input/readers.rs).
test("binary files and text become the same model, which is drawn; so small a scene has no first look", async ({
  page,
}) => {
  const { problems } = watch(page);
  await page.goto("/");
  await page.evaluate(() => {
    const seen = new MutationObserver(() => {
      if (document.querySelector('[data-testid="preliminary"]') !== null) {
        document.body.dataset["preliminary"] = "seen";
      }
    });
    seen.observe(document.body, { subtree: true, childList: true });
  });
  const ofText = await reconstruct(page, "photogrammetric");
  await showProject(page);
  await page.getByRole("button", { name: "New project" }).click();
  expect(await reconstruct(page, "colmap_binary")).toBe(ofText);
  await expect(stage(page, "facets")).toContainText(/[3-9] facets/);
  await expect(async () => {
    expect((await lookOf(page, page.getByTestId("viewer"))).drawn).toBeGreaterThan(0.02);
  }).toPass({ timeout: 20_000 });
  expect(await page.evaluate(() => document.body.dataset["preliminary"])).toBeUndefined();
  expect(problems).toEqual([]);
});

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

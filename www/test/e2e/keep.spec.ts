/** What lasts: the project over reloads, and the page without a network. */
import { expect, test } from "@playwright/test";
import {
  give,
  houseFiles,
  openDemo,
  openParameters,
  runUpTo,
  showProject,
  storedKeys,
  waitForStage,
  watch,
} from "./helpers";

test("what was removed comes back on request", async ({ page }) => {
  await page.goto("/");
  await give(page, houseFiles());
  await expect(page.locator(".view")).toHaveCount(6);
  const views = page.locator(".view");
  for (const left of [5, 4]) {
    await views
      .nth(1)
      .getByRole("button", { name: /^Remove/ })
      .click();
    await expect(views).toHaveCount(left);
  }
  for (const again of [5, 6]) {
    await page.getByRole("button", { name: "Undo" }).click();
    await expect(views).toHaveCount(again);
  }
  await expect(page.getByRole("button", { name: "Undo" })).toHaveCount(0);
  await showProject(page);
  await page.getByRole("button", { name: "New project" }).click();
  await expect(page.locator(".view")).toHaveCount(0);
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(page.locator(".status.good")).toHaveCount(6);
});

test("a reload keeps the project until it is deleted", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await give(page, houseFiles());
  await expect(page.locator(".status.good")).toHaveCount(6);
  await page.locator(".view input[type=checkbox]").nth(2).uncheck();
  await openParameters(page, "Texture");
  const field = page.locator("#param-texture-padding_px");
  await field.fill("5");
  await field.press("Enter");
  await expect(page.getByTestId("kept")).toContainText(/0\.\d MB/);
  await page.waitForTimeout(600);

  await page.goto("about:blank");
  await page.goto("/");
  await showProject(page);
  await expect(page.getByRole("heading", { name: "5 of 6 views" })).toBeVisible();
  await expect(page.locator("#param-texture-padding_px")).toHaveValue("5");
  await runUpTo(page, "Segments");
  await waitForStage(page, "segments");

  await showProject(page);
  await page.getByTestId("kept").getByRole("button", { name: "Delete" }).click();
  await expect(page.getByTestId("entrance")).toBeVisible();
  await expect.poll(() => page.evaluate(storedKeys)).toEqual([]);
  await page.reload();
  await expect(page.getByTestId("entrance")).toBeVisible();
  expect(problems).toEqual([]);
});

test("the page and the demo scene work without a network after the first load", async ({ page, context }) => {
  await page.goto("/");
  await page.evaluate(async () => {
    await navigator.serviceWorker.ready;
  });
  await expect
    .poll(() => page.evaluate(() => navigator.serviceWorker.controller !== null), { timeout: 20_000 })
    .toBe(true);
  await context.setOffline(true);
  await page.reload();
  await openDemo(page);
  await waitForStage(page, "segments", 60_000);
  await expect(page.getByRole("alert")).toHaveCount(0);
});

/** What lasts: the project over reloads, and the page without a network. */
import { expect, test } from "@playwright/test";
import {
  chooseMethod,
  give,
  houseFiles,
  openDemo,
  openHouse,
  openParameters,
  reconstructHouse,
  runButton,
  runUpTo,
  showFace,
  showProject,
  stage,
  storedKeys,
  upload,
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

test("another method, a file and the example take nothing away", async ({ page }) => {
  test.slow();
  const { problems } = watch(page);
  await reconstructHouse(page);
  const found = await stage(page, "lines").textContent();

  await test.step("a method keeps what it found", async () => {
    await chooseMethod(page, "Rectangles");
    await expect(stage(page, "regions")).toHaveAttribute("data-status", "waiting");
    await chooseMethod(page, "Lines");
    await expect(stage(page, "model")).toHaveAttribute("data-status", "done");
    // Nothing has run since: the worker holds it, too.
    await expect(runButton(page)).toBeDisabled();
  });

  await test.step("a file that is added leaves the result in view, outdated, and is taken back", async () => {
    await showFace(page, "Result");
    await give(page, [upload("notes.txt", Buffer.from("of the flight"))]);
    await expect(page.getByText("notes.txt added")).toBeVisible();
    await expect(stage(page, "model")).toHaveAttribute("data-status", "outdated");
    await expect(page.getByRole("button", { name: "Model", exact: true })).toHaveAttribute(
      "aria-pressed",
      "true",
    );
    await expect(page.getByRole("button", { name: "Reconstruct again" })).toBeEnabled();
    await page.getByRole("button", { name: "Undo adding" }).click();
    await expect(stage(page, "model")).toHaveAttribute("data-status", "done");
  });

  await test.step("the example takes the place of a project, which comes back by Ctrl+Z", async () => {
    await showProject(page);
    await openDemo(page);
    await expect(page.getByRole("button", { name: "Project: Detached houses" })).toBeVisible();
    await waitForStage(page, "matches");
    await page.locator("body").press("Control+z");
    await expect(page.getByRole("button", { name: "Project: Own files" })).toBeVisible();
    await expect(stage(page, "model")).toHaveAttribute("data-status", "done");
    expect(await stage(page, "lines").textContent()).toBe(found);
  });
  expect(problems).toEqual([]);
});

test("a reload keeps the project until it is deleted", async ({ page }) => {
  const { problems } = watch(page);
  await openHouse(page);
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

  await test.step("one that was closed is listed at the entrance", async () => {
    await showProject(page);
    await page.getByRole("button", { name: "New project" }).click();
    const listed = page.getByRole("region", { name: "Your last projects" }).getByText("Own files");
    await expect(listed).toBeVisible();
    // It is no longer the one that a visit begins with.
    await expect.poll(() => page.evaluate(storedKeys)).not.toContain("present");
    await page.reload();
    await listed.click();
    await showProject(page);
    await expect(page.getByRole("heading", { name: "5 of 6 views" })).toBeVisible();
    await expect(stage(page, "segments")).toHaveAttribute("data-status", "done");
  });

  await showProject(page, false);
  await page.locator("#param-texture-padding_px").fill("6");
  await page.locator("#param-texture-padding_px").press("Enter");
  await page.getByRole("button", { name: "Steps" }).click();
  await page.getByRole("button", { name: "Undo", exact: true }).click();
  await expect(page.locator("#param-texture-padding_px")).toHaveValue("5");
  await page.keyboard.press("Escape");
  await showProject(page);
  await page.getByTestId("kept").getByRole("button", { name: "Delete" }).click();
  await expect(page.getByTestId("entrance")).toBeVisible();
  await expect.poll(() => page.evaluate(storedKeys)).toEqual([]);
  await page.reload();
  await expect(page.getByTestId("entrance")).toBeVisible();
  expect(problems).toEqual([]);
});

test.describe("without a network", () => {
  test.use({ serviceWorkers: "allow" });

  test("the page and the demo scene work without a network after the first load", async ({
    page,
    context,
  }) => {
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
});

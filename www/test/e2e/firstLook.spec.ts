/** A preliminary model is in view soon, and the run's own takes its place. */
import { expect, test } from "@playwright/test";
import { give, houseFiles, lookOf, openDemo, output, runButton, stage, waitForStage, watch } from "./helpers";

test("a preliminary model is shown before the facets, and replaced by the run's own", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  await openDemo(page);
  const mark = page.getByTestId("preliminary");
  await expect(mark).toHaveText(/preliminary/, { timeout: 60_000 });
  // Not a result: the stage has none, nothing can be saved or corrected.
  await expect(stage(page, "facets")).not.toHaveAttribute("data-status", "done");
  await expect(page.getByRole("button", { name: "Report" })).toHaveCount(0);
  await expect(page.getByTestId("corrections")).toHaveCount(0);
  const viewer = page.getByTestId("viewer");
  let drawn = 0;
  while (drawn < 0.05 && (await mark.count()) > 0) {
    const look = await lookOf(page, viewer);
    // A picture counts if the mark still stands after it was taken.
    drawn = (await mark.count()) > 0 ? look.drawn : drawn;
  }
  expect(drawn).toBeGreaterThan(0.05);

  await waitForStage(page, "model");
  await expect(mark).toHaveCount(0);
  await expect(page.getByRole("button", { name: "Model", exact: true })).toHaveAttribute(
    "aria-pressed",
    "true",
  );
  await expect(await output(page, "model.glb")).toBeVisible();
  await expect(async () => {
    expect((await lookOf(page, viewer)).colours).toBeGreaterThan(40);
  }).toPass({ timeout: 20_000 });
  expect(problems).toEqual([]);
});

test("a small scene has no first look: its own model is soon there", async ({ page }) => {
  await page.goto("/");
  await page.evaluate(() => {
    const seen = new MutationObserver(() => {
      if (document.querySelector('[data-testid="preliminary"]') !== null) {
        document.body.dataset["preliminary"] = "seen";
      }
    });
    seen.observe(document.body, { subtree: true, childList: true });
  });
  await give(page, houseFiles());
  await runButton(page).click();
  await waitForStage(page, "model");
  expect(await page.evaluate(() => document.body.dataset["preliminary"])).toBeUndefined();
});

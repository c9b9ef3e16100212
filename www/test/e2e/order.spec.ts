/** Clicks in any order, with the real core; every pair of actions is in test/unit/app/actionOrder.test.ts. */
import { expect, test } from "@playwright/test";
import {
  give,
  houseFiles,
  openTab,
  output,
  runButton,
  stage,
  storedKeys,
  tabOf,
  waitForStage,
  watch,
} from "./helpers";

test("double clicks, the tour over the demo, own files next, and a reload", async ({ page }) => {
  test.setTimeout(200_000);
  const { problems } = watch(page);
  const alerts = page.getByRole("alert");
  await page.goto("/");
  await page.getByRole("button", { name: "Show me on the example" }).dblclick();
  await page.getByRole("button", { name: "Tour", exact: true }).click();
  await expect(page.getByTestId("tour-step")).toBeVisible();
  await waitForStage(page, "matches");
  await expect(alerts).toHaveCount(0);

  // In the middle of the run.
  await give(page, houseFiles());
  const question = page.getByRole("dialog");
  await expect(question).toContainText("is open");
  await question.getByRole("button", { name: "New project" }).click();
  await expect(page.locator(".status.good")).toHaveCount(6);
  await page.getByRole("button", { name: "End tour" }).click();
  await runButton(page).dblclick();
  await waitForStage(page, "model");
  await expect(alerts).toHaveCount(0);

  await openTab(page, "Model");
  await openTab(page, "3D lines");
  await page.goBack();
  await expect(tabOf(page, "Model")).toHaveAttribute("aria-selected", "true");
  await page.goForward();
  await expect(tabOf(page, "3D lines")).toHaveAttribute("aria-selected", "true");
  await expect
    .poll(() => page.evaluate(storedKeys), { timeout: 10_000 })
    .toEqual(expect.arrayContaining(["present", [expect.any(Number), "results"]]));

  await page.reload();
  await waitForStage(page, "model", 20_000);
  // It was not computed: the core begins with the first stage.
  await expect(page.getByRole("button", { name: "Run up to Segments" })).toBeEnabled();
  await expect(page.getByText("Nothing to show yet.")).toHaveCount(0);
  await expect(await output(page, "model.glb")).toBeVisible();
  await expect(stage(page, "lines")).toHaveAttribute("data-status", "done");
  await expect(alerts).toHaveCount(0);
  expect(problems).toEqual([]);
});

/** The orientation check: it names the mistake, and undoes it on request. */
import { expect, test } from "@playwright/test";
import { demoImages, demoOrientation, give, runUpTo, showProject, waitForStage, watch } from "./helpers";

test("a mistake in the orientation is undone with one click", async ({ page }) => {
  const { problems } = watch(page);
  await page.goto("/");
  const inDegreesAsGon = (text: string) =>
    text.replace(/^(s\S+ \S+ \S+ \S+) (\S+) (\S+) (\S+)$/gm, (_, start, ...angles) =>
      [start, ...angles.slice(0, 3).map((angle: string) => Number(angle) / 0.9)].join(" "),
    );
  await give(page, [...demoImages(6), ...demoOrientation(inDegreesAsGon)]);
  const check = page.getByTestId("orientation-check");
  await expect(check).toBeVisible({ timeout: 60_000 });
  await expect(check).toHaveAttribute("data-finding", "explained");
  await expect(page.getByRole("alert")).toContainText("gon");
  await check.getByText("What was tried").click();
  const rows = check.locator("tbody tr");
  expect(await rows.count()).toBeGreaterThan(4);
  await expect(rows.first()).toContainText("in gon");
  const [before, after] = (await check.locator("dd").allTextContents()).map(Number) as [number, number];
  expect(before).toBeLessThan(0.25);
  expect(after).toBeGreaterThan(0.3);

  await check.getByRole("button", { name: "Apply the fix" }).click();
  await expect(page.getByRole("alert")).toHaveCount(0, { timeout: 60_000 });
  await expect(page.locator(".warnings")).toContainText("the orientation was corrected");
  await runUpTo(page, "3D lines");
  await waitForStage(page, "lines");
  await expect(page.locator('[data-stage="lines"]')).toContainText(/[1-9]\d* lines/);
  await showProject(page);
  await page.getByRole("button", { name: "Take the orientation as it is" }).click();
  await expect(page.getByTestId("orientation-check")).toBeVisible({ timeout: 60_000 });
  expect(problems).toEqual([]);
});

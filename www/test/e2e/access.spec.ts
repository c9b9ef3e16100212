import { expect, type Page, test } from "@playwright/test";
import axe from "axe-core";
import { give, houseFiles, stage, waitForStage } from "./helpers";

/** Serious and critical findings of axe, as text. */
async function findings(page: Page): Promise<string[]> {
  await page.evaluate(axe.source);
  return page.evaluate(async () => {
    const { axe: runner } = window as unknown as { axe: typeof import("axe-core") };
    const { violations } = await runner.run();
    return violations
      .filter(({ impact }) => impact === "serious" || impact === "critical")
      .map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" | ")}`);
  });
}

for (const colorScheme of ["light", "dark"] as const) {
  test(`nothing serious for axe in ${colorScheme}`, async ({ page }) => {
    await page.emulateMedia({ colorScheme });
    await page.goto("/");
    await expect(stage(page, "segments")).toBeVisible();
    expect(await findings(page)).toEqual([]);
    await give(page, houseFiles());
    await page.getByRole("button", { name: "Run up to Segments" }).click();
    await waitForStage(page, "segments");
    expect(await findings(page)).toEqual([]);
  });
}

test("tabs follow the arrow keys, and the theme its switch", async ({ page }) => {
  await page.emulateMedia({ colorScheme: "light" });
  await page.goto("/");
  await page.getByRole("tab", { name: "Images" }).focus();
  await page.keyboard.press("ArrowRight");
  await expect(page.getByRole("tab", { name: "Segments" })).toBeFocused();
  await expect(page.getByRole("tab", { name: "Segments" })).toHaveAttribute("aria-selected", "true");
  await page.getByRole("button", { name: "Dark" }).click();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
  await page.reload();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
});

test("nothing is cut off at 1024 pixels", async ({ page }) => {
  await page.setViewportSize({ width: 1024, height: 768 });
  await page.goto("/");
  await expect(stage(page, "model")).toBeVisible();
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  expect(overflow).toBeLessThanOrEqual(0);
});

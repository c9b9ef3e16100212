import { expect, test } from "@playwright/test";
import { axeFindings, give, houseFiles, openTab, stage, waitForStage } from "./helpers";

for (const colorScheme of ["light", "dark"] as const) {
  test(`nothing serious for axe in ${colorScheme}`, async ({ page }) => {
    await page.emulateMedia({ colorScheme });
    await page.goto("/");
    await expect(stage(page, "segments")).toBeVisible();
    expect(await axeFindings(page)).toEqual([]);
    await give(page, houseFiles());
    await page.getByRole("button", { name: "Run up to Segments" }).click();
    await waitForStage(page, "segments");
    expect(await axeFindings(page)).toEqual([]);
  });
}

for (const [method, last] of [
  ["Lines", "Model"],
  ["Rectangles", "Rectangles"],
] as const) {
  test(`nothing serious for axe in any tab of method ${method}`, async ({ page }) => {
    await page.goto("/");
    await page.getByRole("button", { name: method, exact: true }).click();
    await give(page, houseFiles());
    await page.getByRole("button", { name: `Run up to ${last}` }).click();
    await waitForStage(page, last.toLowerCase());
    const tabs = await page.getByRole("tab").allTextContents();
    expect(tabs.length).toBeGreaterThan(5);
    for (const name of tabs) {
      await openTab(page, name);
      expect(await axeFindings(page), name).toEqual([]);
    }
    for (const tool of method === "Lines" ? ["Measure", "Section"] : []) {
      await page.getByRole("button", { name: tool }).click();
      expect(await axeFindings(page), tool).toEqual([]);
    }
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
  const hidden = await page
    .getByRole("tablist", { name: "Stage views" })
    .evaluate((list) => list.scrollWidth - list.clientWidth);
  expect(hidden).toBeLessThanOrEqual(0);
});

test("text grows on request, and stays so", async ({ page }) => {
  const size = () =>
    page.evaluate(() => Number.parseFloat(getComputedStyle(document.documentElement).fontSize));
  await page.goto("/");
  const usual = await size();
  await page.getByRole("button", { name: /^Text size/ }).click();
  await page.getByRole("button", { name: /^Text size/ }).click();
  expect((await size()) / usual).toBeCloseTo(1.3, 2);
  await page.reload();
  expect((await size()) / usual).toBeCloseTo(1.3, 2);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  expect(overflow).toBeLessThanOrEqual(0);
});
